# Sets THAWSLIDE_WITH_CUDA, and enables CUDA where it is ON. Nothing is found: the build goes on without, unless
# THAWSLIDE_CUDA is ON.
set(THAWSLIDE_WITH_CUDA OFF)
if(NOT THAWSLIDE_CUDA MATCHES "^(AUTO|ON|OFF)$")
  message(FATAL_ERROR "THAWSLIDE_CUDA is ${THAWSLIDE_CUDA}; it may be AUTO, ON or OFF")
endif()
if(NOT THAWSLIDE_CUDA STREQUAL "OFF")
  find_program(THAWSLIDE_NVCC nvcc HINTS $ENV{CUDA_HOME}/bin /usr/local/cuda/bin)
  set(why_not "no nvcc on the path, in CUDA_HOME or in /usr/local/cuda")
  if(THAWSLIDE_NVCC)
    execute_process(COMMAND ${THAWSLIDE_NVCC} --version OUTPUT_VARIABLE version ERROR_QUIET)
    if(version MATCHES "release ([0-9]+)\\.([0-9]+)" AND CMAKE_MATCH_1 GREATER_EQUAL 12)
      set(THAWSLIDE_WITH_CUDA ON)
    else()
      set(why_not "${THAWSLIDE_NVCC} is no nvcc of version 12 or later, as C++20 needs")
    endif()
  endif()
  if(THAWSLIDE_WITH_CUDA)
    # An nvcc that does not work with this compiler is no reason to fail.
    include(CheckLanguage)
    set(ENV{CUDACXX} ${THAWSLIDE_NVCC})
    set(ENV{CUDAHOSTCXX} ${CMAKE_CXX_COMPILER})
    check_language(CUDA)
    if(NOT CMAKE_CUDA_COMPILER)
      set(THAWSLIDE_WITH_CUDA OFF)
      set(why_not "${THAWSLIDE_NVCC} does not work with ${CMAKE_CXX_COMPILER}")
    endif()
  endif()
  if(THAWSLIDE_WITH_CUDA)
    set(CMAKE_CUDA_ARCHITECTURES ${THAWSLIDE_CUDA_ARCHITECTURES})
    enable_language(CUDA)
    # CMake 3.25 does not know how nvcc is asked for C++20.
    if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
      set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
      set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION -std=c++20)
    endif()
    find_package(CUDAToolkit REQUIRED)
    message(STATUS "Built for NVIDIA GPUs of compute capability ${THAWSLIDE_CUDA_ARCHITECTURES}")
  elseif(THAWSLIDE_CUDA STREQUAL "ON")
    message(FATAL_ERROR "THAWSLIDE_CUDA is ON, but: ${why_not}. Install CUDA, or set CUDA_HOME")
  else()
    message(STATUS "Built without CUDA: ${why_not}")
  endif()
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
