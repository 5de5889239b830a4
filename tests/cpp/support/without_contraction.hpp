// Included before all else where bits are compared (tests/CMakeLists.txt). Eigen adds up small vectors of numbers in
// registers of its own, with contracted products: not here, while its types keep the alignment that they have
// elsewhere.
#pragma once

#define EIGEN_DONT_VECTORIZE
#ifdef __AVX512F__
#define EIGEN_MAX_STATIC_ALIGN_BYTES 64
#else
#define EIGEN_MAX_STATIC_ALIGN_BYTES 32
#endif
