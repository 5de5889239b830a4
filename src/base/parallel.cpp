#include "base/parallel.hpp"

#include <omp.h>

#include "base/error.hpp"

namespace thawslide {

int thread_count() { return omp_get_max_threads(); }

void set_thread_count(int threads) {
  THAWSLIDE_ASSERT(threads >= 1, "{} threads", threads);
  omp_set_num_threads(threads);
}

int available_cores() { return omp_get_num_procs(); }

}  // namespace thawslide
