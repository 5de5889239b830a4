#include "base/parallel.hpp"

#include <omp.h>
#include <unistd.h>

#include <cstdlib>

#include "base/error.hpp"

namespace thawslide {

int thread_count() { return omp_get_max_threads(); }

void set_thread_count(int threads) {
  THAWSLIDE_ASSERT(threads >= 1, "{} threads", threads);
  omp_set_num_threads(threads);
}

int available_cores() { return omp_get_num_procs(); }

void let_threads_wait_passively(char** arguments) {
  if (std::getenv("OMP_WAIT_POLICY") == nullptr) {
    setenv("OMP_WAIT_POLICY", "passive", 1);
    setenv("GOMP_SPINCOUNT", "1000", 0);
    execv("/proc/self/exe", arguments);
  }
}

}  // namespace thawslide
