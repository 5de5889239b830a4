# CUDA, if the GPU backend is requested (./run --setup --gpu).
if(THAWSLIDE_CUDA)
  find_program(THAWSLIDE_NVCC nvcc HINTS $ENV{CUDA_HOME}/bin /usr/local/cuda/bin)
  if(NOT THAWSLIDE_NVCC)
    message(FATAL_ERROR "THAWSLIDE_CUDA is ON, but nvcc is not in PATH, CUDA_HOME or /usr/local/cuda. Install CUDA 12 or "
                        "later, or set CUDA_HOME")
  endif()
  set(CMAKE_CUDA_COMPILER ${THAWSLIDE_NVCC})
  set(CMAKE_CUDA_HOST_COMPILER ${CMAKE_CXX_COMPILER})
  set(CMAKE_CUDA_ARCHITECTURES ${THAWSLIDE_CUDA_ARCHITECTURES})
  enable_language(CUDA)
  if(CMAKE_CUDA_COMPILER_VERSION VERSION_LESS 12)
    message(FATAL_ERROR "${THAWSLIDE_NVCC} has version ${CMAKE_CUDA_COMPILER_VERSION}; C++20 needs CUDA 12 or later")
  endif()
  # CMake 3.25 has no option of nvcc for C++20.
  if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
    set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
    set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION -std=c++20)
  endif()
  find_package(CUDAToolkit REQUIRED)
endif()

# Flags of all targets with device code. Products and sums are contracted neither on the GPU nor
# on the CPU: results can then be compared bit by bit. Eigen 3.4 marks functions that need no mark (20012).
add_library(thawslide_device_flags INTERFACE)
target_include_directories(thawslide_device_flags INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(thawslide_device_flags INTERFACE Eigen3::Eigen)
set(for_nvcc "$<COMPILE_LANGUAGE:CUDA>")
set(for_cxx "$<COMPILE_LANGUAGE:CXX>")
target_compile_options(thawslide_device_flags INTERFACE
  $<${for_nvcc}:--fmad=false> $<${for_nvcc}:--expt-relaxed-constexpr>
  "$<${for_nvcc}:SHELL:-diag-suppress 20012>" "$<${for_nvcc}:SHELL:-Werror all-warnings>"
  $<${for_nvcc}:-Xcompiler=-Wall,-Wextra,-ffp-contract=off>
  $<${for_cxx}:-Wall> $<${for_cxx}:-Wextra> $<${for_cxx}:-Wpedantic> $<${for_cxx}:-ffp-contract=off>)
