// Messages of errors and warnings.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "base/error.hpp"

namespace thawslide::testing_support {

// Message of the error that the work throws; other exceptions fail the test.
template <class Error = UserError, class Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

inline void expect_in(const std::string& text, const std::string& fragment) {
  EXPECT_NE(text.find(fragment), std::string::npos) << text << "\nlacks\n" << fragment;
}

}  // namespace thawslide::testing_support
