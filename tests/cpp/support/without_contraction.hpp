// Included first where results are compared bitwise (tests/CMakeLists.txt). It prevents Eigen from summing small
// vectors in registers with contracted products. The alignment of its types stays the same as elsewhere.
#pragma once

#define EIGEN_DONT_VECTORIZE
#ifdef __AVX512F__
#define EIGEN_MAX_STATIC_ALIGN_BYTES 64
#else
#define EIGEN_MAX_STATIC_ALIGN_BYTES 32
#endif
