// Extension module thawslide._core, whose public form is python/thawslide/case.py and simulation.py.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>
#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <utility>

#include "base/clocks.hpp"
#include "base/error.hpp"
#include "base/parallel.hpp"
#include "config/case_layers.hpp"
#include "config/describe.hpp"
#include "config/read_case.hpp"
#include "python/bindings.hpp"
#include "python/observer.hpp"
#include "run/block_model.hpp"
#include "run/live_run.hpp"
#include "run/run_loop.hpp"
#include "run/start.hpp"
#include "terrain/basal_law.hpp"
#include "version.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace thawslide::python {

namespace {

// Calls a law with copies of the arrays of the nodes, without the GIL, and replaces their strengths by its result.
void set_strengths(const nb::object& law, terrain::LoadedNodes& nodes) {
  const nb::gil_scoped_acquire gil;
  const std::size_t count = nodes.strength.size();
  if (count == 0) {
    return;
  }
  nb::dict of;
  of["time"] = nodes.time;
  of["dt"] = nodes.dt;
  of["position"] = copied(nodes.position, {count, nodes.position.size() / count});
  of["area"] = copied(nodes.area, {count});
  of["substrate"] = copied(nodes.substrate, {count});
  of["normal_pressure"] = copied(nodes.normal_pressure, {count});
  of["pore_pressure"] = copied(nodes.pore_pressure, {count});
  of["temperature"] = copied(nodes.temperature, {count});
  of["saturation"] = copied(nodes.saturation, {count});
  of["solid_fraction"] = copied(nodes.solid_fraction, {count});
  of["slip"] = copied(nodes.slip, {count});
  of["speed"] = copied(nodes.speed, {count});
  of["unit_weight"] = copied(nodes.unit_weight, {count});
  of["strength"] = copied(nodes.strength, {count});
  const auto strength = nb::cast<nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>>(law(of));
  if (strength.shape(0) != count) {
    throw std::logic_error("a basal law returned another number of strengths");  // checked in simulation.py
  }
  std::copy_n(strength.data(), count, nodes.strength.begin());
}

// Result of work() without the GIL, with the exceptions of the observer.
template <class Work>
auto computed(PythonObserver& observer, int threads, const Work& work) {
  return observer.result_of([&] {
    const nb::gil_scoped_release released;
    const ThreadScope scope(threads);
    return work();
  });
}

// Live run for Python, which one thread at a time uses: its methods release the GIL.
class Live {
 public:
  Live(std::unique_ptr<run::LiveRun> live, PythonObserver& observer) : live_(std::move(live)), observer_(observer) {}

  // Calls work(live run) without the GIL. Throws UserError if another thread uses it.
  template <class Work>
  auto use(int threads, const Work& work) {
    if (is_in_use_.exchange(true)) {
      throw UserError("another thread uses this simulation. Wait until it has finished.");
    }
    struct Release {
      std::atomic<bool>& is_in_use;
      ~Release() { is_in_use = false; }
    } const release{is_in_use_};
    return computed(observer_, threads, [&] { return work(*live_); });
  }

  // Advances until a time, for a number of steps, or for a wall-clock time. law: None, or one of basal strengths.
  void advance(double until, std::int64_t steps, double seconds, int threads, const nb::object& law) {
    const terrain::StrengthLaw strength = [&law](terrain::LoadedNodes& nodes) { set_strengths(law, nodes); };
    const terrain::StrengthLaw* replacing = law.is_none() ? nullptr : &strength;
    use(threads, [&](run::LiveRun& live) {
      const double begin = wall_clock();
      for (std::int64_t k = 0; k < steps && live.time() < until && !live.is_done() && !observer_.has_exception(); ++k) {
        live.step(replacing);
        if (wall_clock() - begin >= seconds) {
          return;
        }
      }
    });
  }

  [[nodiscard]] const run::LiveRun& get() const { return *live_; }

 private:
  std::unique_ptr<run::LiveRun> live_;
  PythonObserver& observer_;
  std::atomic<bool> is_in_use_{false};
};

// Read-only array of a field: (particles) or (blocks, lanes, components); a view, unless a step may move the memory.
nb::object field_view(Live& self, const std::string& name) {
  const run::FieldMemory memory = self.use(1, [&](run::LiveRun& live) { return live.field(name); });
  const auto view = [&]<class T>(T /*type*/) -> nb::object {
    const std::size_t numbers = memory.blocks * memory.lanes * memory.components;
    const auto* data = static_cast<const T*>(memory.data);
    std::unique_ptr<std::shared_ptr<const void>> owner;
    if (memory.may_move) {
      auto copy = std::make_shared<std::vector<T>>(data, data + numbers);
      data = copy->data();
      owner = std::make_unique<std::shared_ptr<const void>>(copy);
    } else {
      owner = std::make_unique<std::shared_ptr<const void>>(memory.owner);
    }
    const nb::capsule base(owner.release(),
                           [](void* held) noexcept { delete static_cast<std::shared_ptr<const void>*>(held); });
    if (memory.components == 1) {
      const std::size_t shape[] = {memory.particles};
      return nb::cast(nb::ndarray<nb::numpy, const T>(data, 1, shape, base));
    }
    const std::size_t shape[] = {memory.blocks, memory.lanes, memory.components};
    const auto lanes = static_cast<std::int64_t>(memory.lanes);
    const std::int64_t strides[] = {lanes * static_cast<std::int64_t>(memory.components), 1, lanes};
    return nb::cast(nb::ndarray<nb::numpy, const T>(data, 3, shape, base, strides));
  };
  if (!memory.is_integer) {
    return view(double{});
  }
  return memory.bytes == sizeof(std::int64_t) ? view(std::int64_t{}) : view(std::int32_t{});
}

using Texts = std::vector<std::pair<std::string, std::string>>;

// Case from paths and texts of its files, and from `--set` texts and the folders of their paths.
config::Case case_of(const Texts& files, const Texts& sets) {
  std::vector<config::CaseFile> read;
  for (const auto& [file, text] : files) {
    read.push_back({file, text});
  }
  std::vector<config::Override> overrides;
  for (const auto& [set, folder] : sets) {
    overrides.push_back(config::parse_override(set));
    overrides.back().folder = folder;
  }
  return config::case_of(read, overrides);
}

nb::dict columns_of(const std::vector<sim::HistoryRow>& rows) {
  nb::dict columns;
  for (std::size_t c = 0; !rows.empty() && c < rows.front().size(); ++c) {
    std::vector<double> values;
    for (const sim::HistoryRow& row : rows) {
      values.push_back(row[c].second);
    }
    columns[rows.front()[c].first.c_str()] = copied(values, {values.size()});
  }
  return columns;
}

// Position, mass and velocity of nodes.
nb::tuple nodes_of(Live& self) {
  const run::NodeTable table = self.use(1, [](run::LiveRun& live) { return live.nodes(); });
  const std::size_t count = table.mass.size();
  return nb::make_tuple(copied(table.position, {count, table.dimension}), copied(table.mass, {count}),
                        copied(table.velocity, {count, table.dimension}));
}

}  // namespace

}  // namespace thawslide::python

NB_MODULE(_core, module) {
  using namespace thawslide;
  using namespace thawslide::python;

  module.attr("version") = version;
  pthread_atfork(end_waiting_threads, nullptr, nullptr);

  nb::exception<UserError> user_error(module, "UserError", PyExc_ValueError);
  nb::exception<WriteError>(module, "WriteError", user_error.ptr());
  nb::exception<RunError>(module, "RunError", PyExc_RuntimeError);
  nb::exception<DeviceError>(module, "DeviceError", PyExc_RuntimeError);
  bind_files(module);

  nb::class_<config::Case>(module, "Case")
      .def_ro("name", &config::Case::name)
      .def_ro("file", &config::Case::file)
      .def_prop_ro("title", [](const config::Case& self) { return self.general.title; })
      .def_prop_ro("dimension", [](const config::Case& self) { return self.general.dimension; })
      .def_prop_ro("end", [](const config::Case& self) { return self.time.end; });
  nb::enum_<ExitCode>(module, "ExitCode")
      .value("DONE", ExitCode::done)
      .value("USER_MISTAKE", ExitCode::user_mistake)
      .value("RUN_FAILED", ExitCode::run_failed)
      .value("STOPPED", ExitCode::stopped_by_signal)
      .value("NOT_WRITTEN", ExitCode::not_written)
      .value("DEVICE_FAILED", ExitCode::device_failed);

  module.def("read_case_files", [](const std::string& file) {
    Texts files;
    for (const config::CaseFile& each : config::read_case_files(file)) {
      files.emplace_back(each.file.string(), each.text);
    }
    return files;
  });
  module.def("case_of", [](const Texts& files, const Texts& sets) { return case_of(files, sets); });
  module.def("schema_json", &config::schema_json);
  module.def("resolved_toml", [](const config::Case& parameters) { return config::resolved_toml(parameters, ""); });

  nb::class_<run::ProgressState>(module, "ProgressState")
      .def_ro("time", &run::ProgressState::time)
      .def_ro("end", &run::ProgressState::end)
      .def_ro("steps", &run::ProgressState::steps)
      .def_ro("front_position", &run::ProgressState::front_position)
      .def_ro("front_speed", &run::ProgressState::front_speed);
  nb::class_<run::Observer>(module, "AnyObserver");
  nb::class_<PythonObserver, run::Observer>(module, "Observer")
      .def(nb::init<>())
      .def("progress",
           [](PythonObserver& self, const run::ProgressState& state) { self.run::Observer::progress(state); })
      .def("end_progress", [](PythonObserver& self) { self.run::Observer::end_progress(); });

  nb::class_<run::FieldDescription>(module, "FieldDescription")
      .def_ro("name", &run::FieldDescription::name)
      .def_ro("unit", &run::FieldDescription::unit)
      .def_ro("text", &run::FieldDescription::text)
      .def_ro("components", &run::FieldDescription::components);
  nb::class_<Live>(module, "LiveRun")
      .def_prop_ro("time", [](const Live& self) { return self.get().time(); })
      .def_prop_ro("step_number", [](const Live& self) { return self.get().step_number(); })
      .def_prop_ro("particle_count", [](const Live& self) { return self.get().particle_count(); })
      .def_prop_ro("is_done", [](const Live& self) { return self.get().is_done(); })
      .def_prop_ro("end_text", [](const Live& self) { return self.get().end_text(); })
      .def_prop_ro("has_basal_law", [](const Live& self) { return self.get().has_basal_law(); })
      .def_prop_ro("origin", [](const Live& self) { return self.get().origin(); })
      .def_prop_ro("fields", [](const Live& self) { return self.get().fields(); })
      .def("field", &field_view, nb::sig("def field(self, name: str, /) -> object"))
      .def(
          "history",
          [](Live& self) { return columns_of(self.use(1, [](run::LiveRun& live) { return live.history(); })); },
          nb::sig("def history(self) -> dict[str, object]"))
      .def(
          "row", [](Live& self) { return columns_of({self.use(1, [](run::LiveRun& live) { return live.row(); })}); },
          nb::sig("def row(self) -> dict[str, object]"))
      .def(
          "key_numbers",
          [](Live& self) {
            nb::dict numbers;
            for (const auto& [name, value] : self.use(1, [](run::LiveRun& live) { return live.key_numbers(); })) {
              numbers[name.c_str()] = value;
            }
            return numbers;
          },
          nb::sig("def key_numbers(self) -> dict[str, float]"))
      .def_prop_ro("maps", [](const Live& self) { return self.get().maps(); })
      .def(
          "map",
          [](Live& self, const std::string& name) {
            const Raster map = self.use(1, [&](run::LiveRun& live) { return live.map(name); });
            const auto rows = static_cast<std::size_t>(map.rows), columns = static_cast<std::size_t>(map.columns);
            return nb::make_tuple(copied(map.values, {rows, columns}), map.x, map.y, map.cell_x, map.cell_y, map.crs);
          },
          nb::sig("def map(self, name: str, /) -> tuple[object, float, float, float, float, str]"))
      .def("nodes", &nodes_of, nb::sig("def nodes(self) -> tuple[object, object, object]"))
      .def("advance", &Live::advance, "until"_a, "steps"_a, "seconds"_a, "threads"_a, "law"_a.none())
      .def("checkpoint",
           [](Live& self, int threads) {
             const std::string bytes = self.use(threads, [](run::LiveRun& live) { return live.checkpoint(); });
             return nb::bytes(bytes.data(), bytes.size());
           })
      .def("restore",
           [](Live& self, const nb::bytes& bytes, int threads) {
             const std::string checkpoint(bytes.c_str(), bytes.size());
             self.use(threads, [&](run::LiveRun& live) { live.restore(checkpoint); });
           })
      .def("change", [](Live& self, const config::Case& next, const std::vector<std::string>& sets, int threads) {
        self.use(threads, [&](run::LiveRun& live) { live.change(next, sets); });
      });
  // The caller keeps the observer: a reference from here would be invisible to the garbage collector of Python.
  module.def("make_live_run", [](const config::Case& parameters, const std::string& device, int threads,
                                 PythonObserver& observer) {
    return std::make_unique<Live>(
        computed(observer, threads, [&] { return run::make_live_run(parameters, device, observer); }), observer);
  });
  // Both return the exit code of the command line, and rethrow an exception that interrupted the run.
  module.def("start_run", [](const config::Case& parameters, const std::string& folder, bool overwrite,
                             const std::string& device, int threads, PythonObserver& observer) {
    return computed(observer, threads, [&] {
      return run::start_run(parameters, {folder, overwrite, device}, observer);
    });
  });
  module.def("resume_run", [](const std::string& folder, const std::vector<std::string>& sets,
                              const std::string& device, int threads, PythonObserver& observer) {
    return computed(observer, threads, [&] { return run::resume_run({folder, sets, device}, observer); });
  });
  module.def("run_folder", [](const config::Case& parameters) { return run::usual_run_folder(parameters).string(); });
  module.def(
      "block",
      [](const config::Case& parameters, PythonObserver& observer, int threads) {
        return columns_of(computed(observer, threads, [&] { return run::block_rows(parameters, observer); }));
      },
      nb::sig("def block(parameters: Case, observer: Observer, threads: int, /) -> dict[str, object]"));
}
