// Observer of a run that is implemented in Python.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/trampoline.h>

#include <exception>
#include <string>
#include <type_traits>
#include <utility>

#include "base/clocks.hpp"
#include "base/error.hpp"
#include "run/observer.hpp"

namespace thawslide::python {

namespace nb = nanobind;

// The steps run without the GIL; each call acquires it. An exception of a call or of a
// signal handler interrupts the run after its present step, as Ctrl-C does, and is rethrown at the end (result_of).
class PythonObserver : public run::Observer {
 public:
  NB_TRAMPOLINE(run::Observer);

  void text(const std::string& line) override {
    call([&] { NB_OVERRIDE_PURE(text, line); });
  }
  void error(const std::string& line) override {
    call([&] { NB_OVERRIDE_PURE(error, line); });
  }
  bool wants_progress(double /*time*/, double /*end*/) override { return is_due(last_progress_, progress_interval); }
  void progress(const run::ProgressState& state) override {
    call([&] { NB_OVERRIDE(progress, state); });
  }
  void end_progress() override {
    call([&] { NB_OVERRIDE(end_progress); });
  }
  std::string interruption() override {
    if (!exception_ && is_due(last_check_, check_interval)) {
      call([] {
        if (PyErr_CheckSignals() != 0) {
          throw nb::python_error();
        }
      });
    }
    return interruption_;
  }

  [[nodiscard]] bool has_exception() const { return exception_ != nullptr; }

  // Returns the result of work(), or rethrows an exception of the observer. Such an exception replaces an error of the
  // run, which may follow from it; RunError is then its context.
  template <class Work>
  auto result_of(const Work& work) {
    try {
      if constexpr (std::is_void_v<decltype(work())>) {
        work();
        rethrow_exception();
      } else {
        auto result = work();
        rethrow_exception();
        return result;
      }
    } catch (const RunError& error) {
      if (exception_) {
        set_context(error);
      }
      rethrow_exception();
      throw;
    } catch (const UserError&) {
      rethrow_exception();
      throw;
    }
  }

 private:
  static constexpr double progress_interval = 0.2, check_interval = 0.05;  // wall-clock time [s]

  void rethrow_exception() {
    if (exception_) {
      std::rethrow_exception(std::exchange(exception_, nullptr));
    }
  }
  void set_context(const RunError& error) {
    const nb::gil_scoped_acquire gil;
    try {
      std::rethrow_exception(exception_);
    } catch (const nb::python_error& raised) {
      nb::object context = nb::module_::import_("thawslide._core").attr("RunError")(error.what());
      PyException_SetContext(raised.value().ptr(), context.release().ptr());
    }
  }

  template <class Work>
  void call(const Work& work) {
    const nb::gil_scoped_acquire gil;
    try {
      work();
    } catch (const nb::python_error& error) {
      if (!exception_) {
        interruption_ = nb::cast<std::string>(error.type().attr("__name__"));
        exception_ = std::current_exception();
      }
    }
  }
  static bool is_due(double& last, double interval) {
    const double now = wall_clock();
    if (now - last < interval) {
      return false;
    }
    last = now;
    return true;
  }

  double last_progress_ = wall_clock(), last_check_ = wall_clock();
  std::string interruption_;
  std::exception_ptr exception_;
};

}  // namespace thawslide::python
