"""Device code of the step: compiled if nvcc is available, within limits of registers."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
GPU = ROOT / "src" / "device" / "gpu.cu"
OLDEST = 12  # version of nvcc: the first with C++20
LIMIT = 1200.0  # s; the step on a GPU needs 150

# Maximum registers of launched passes over particles in 2D and in 3D, of the variant with the most: those of nvcc 13.0,
# and about a tenth more for other versions. A multiprocessor of sm_90 has 65,536, so that 80 leave it 24 groups of 32
# threads, 96 leave it 20.
REGISTERS_OF_STEP = {
    "AddAffineMomentum": (88, 112),  # 80, 100
    "AddAverages": (52, 64),  # 46, 58
    "AddFilterMoments": (60, 72),  # 53, 64
    "AddFilterMomentum": (60, 72),  # 53, 64
    "AddMomentum": (88, 76),  # 79, 68
    "AddNearGround": (54, 88),  # 48, 80
    "AddPressureLoad": (38, 48),  # 34, 42
    "AddSeepingWater": (56, 62),  # 50, 56
    "ApplyFiltered": (80, 108),  # 72, 98
    "HeatFlows": (88, 104),  # 80, 93
    "MarkBand": (36, 42),  # 32, 38
    "MarkEscaped": (34, 36),  # 30, 32
    "Move": (80, 106),  # 72, 96
    "MoveAffine": (104, 222),  # 94, 200
    "OfMaterial LinearElastic": (88, 132),  # 80, 120
    "OfMaterial MohrCoulomb<false>": (142, 168),  # 128, 152
    "OfMaterial MohrCoulomb<true>": (158, 180),  # 142, 162
    "RedistributeUnreachedHeat": (36, 44),  # 32, 40
    "RescaleBand": (84, 84),  # 76, 76
    "SecantCapacity": (82, 86),  # 74, 78
    "SeepageFlows": (72, 84),  # 64, 76
    "SumOf": (118, 100),  # 106, 90
    "SweepFilter": (72, 106),  # 64, 96
    "UpdateHeat": (60, 60),  # 53, 53
    "UpdateHeatApparentCapacity": (62, 62),  # 56, 56
    "UpdatePorePressure": (82, 88),  # 74, 80
    "UpdatePosition": (72, 106),  # 64, 96
}


def find_nvcc() -> str:
    cuda_home = os.environ.get("CUDA_HOME", "/usr/local/cuda")
    nvcc = shutil.which("nvcc") or shutil.which("nvcc", path=f"{cuda_home}/bin")
    if not nvcc:
        pytest.skip(f"no nvcc on the path or in {cuda_home}/bin: device code is not compiled")
    reported = subprocess.run([nvcc, "--version"], capture_output=True, text=True, timeout=LIMIT, check=True).stdout
    version = re.search(r"release (\d+)\.(\d+)", reported)
    assert version, reported
    if int(version.group(1)) < OLDEST:
        pytest.skip(f"{nvcc} is of version {version.group(1)}.{version.group(2)}; C++20 needs {OLDEST}.0")
    return nvcc


def compiled(nvcc: str, source: Path, folder: Path) -> str:
    """Compile for sm_90; return the output of the compiler and ptxas, with names as in the source."""
    eigen = subprocess.run(["pkg-config", "--cflags-only-I", "eigen3"], capture_output=True, text=True, check=True)
    options = ["-std=c++20", "-arch=sm_90", f"-I{ROOT / 'src'}", "--expt-relaxed-constexpr", "--ptxas-options=-v"]
    options += ["-Werror", "all-warnings", "-Xcompiler", "-Wall,-Wextra"]
    for place in eigen.stdout.split():
        options += ["-isystem", place.removeprefix("-I")]
    options += ["-diag-suppress", "20012"]  # Eigen 3.4 marks functions that need no mark
    command = [nvcc, *options, "-c", str(source), "-o", str(folder / "kernels.o")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT, check=False)
    reported = done.stdout + done.stderr
    assert done.returncode == 0, f"{' '.join(command)}\n{reported}"
    return subprocess.run(["c++filt"], input=reported, capture_output=True, text=True, check=True).stdout


def short_name(demangled: str) -> str:
    name = re.sub(r"thawslide::(?:physics::|mpm::|band::|terrain::|device::)?", "", demangled.removeprefix("void "))
    return re.sub("> (?=>)", ">", name).split("(")[0]


def resources(reported: str) -> dict[str, tuple[int, int]]:
    found = {}
    for part in reported.split("Compiling entry function '")[1:]:
        spilled = [int(number) for number in re.findall(r"(\d+) bytes spill", part)]
        registers = re.search(r"Used (\d+) registers", part)
        assert spilled and registers, part
        found[short_name(part.split("' for '")[0])] = (int(registers.group(1)), sum(spilled))
    return found


def expect_within(limits: dict[str, int], used: dict[str, tuple[int, int]]) -> None:
    assert set(used) == set(limits)
    assert {kernel: spilled for kernel, (_, spilled) in used.items() if spilled > 0} == {}
    assert {kernel: number for kernel, (number, _) in used.items() if number > limits[kernel]} == {}


def test_spills_and_unmarked_functions_are_found(tmp_path: Path) -> None:
    nvcc = find_nvcc()
    greedy = tmp_path / "greedy.cu"
    greedy.write_text("""#include "base/select.hpp"
__global__ void __launch_bounds__(1024, 2) greedy(double* numbers) {
  double kept[64];
  thawslide::unrolled<64>([&](auto k) { kept[k] = numbers[threadIdx.x + 32 * k]; });
  __syncthreads();
  thawslide::unrolled<64>([&](auto k) { numbers[threadIdx.x + 32 * k] = kept[63 - k]; });
}
""")
    registers, spilled = resources(compiled(nvcc, greedy, tmp_path))["greedy"]
    assert registers <= 32
    assert spilled > 0
    unmarked = tmp_path / "unmarked.cu"
    unmarked.write_text("""double twice(double number) { return 2 * number; }
__global__ void unmarked(double* numbers) { numbers[0] = twice(numbers[0]); }
""")
    with pytest.raises(AssertionError, match="twice"):
        compiled(nvcc, unmarked, tmp_path)


def test_emulated_gpu_steps_are_bitwise_identical_to_cpu_steps() -> None:
    """The program compares CPU steps with emulated GPU threads in shuffled order, for each model option."""
    find_nvcc()
    folder = ROOT / "build" / "gpu"
    configure = ["cmake", "--preset", "release", "-B", folder, "-DTHAWSLIDE_CUDA=ON"]
    for command in (configure, ["cmake", "--build", folder, "--target", "thawslide_device_test"]):
        built = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=LIMIT, check=False)
        assert built.returncode == 0, built.stdout[-4000:] + built.stderr[-2000:]
    program = folder / "tests" / "thawslide_device_test"
    done = subprocess.run([program, "--rehearse"], capture_output=True, text=True, timeout=LIMIT, check=False)
    assert done.returncode == 0, done.stdout
    compared = re.findall(r"(\d+) of (\d+) (?:fields|numbers) have the same bits", done.stdout)
    assert len(compared) > 60
    assert [(same, count) for same, count in compared if same != count] == []


def test_the_step_on_a_gpu_compiles_without_spills_within_its_registers(tmp_path: Path) -> None:
    """Kernels are those that are launched: passes by groups of threads, nodes, sorting."""
    used = resources(compiled(find_nvcc(), GPU, tmp_path))
    kernels = {kernel: numbers for kernel, numbers in used.items() if kernel.startswith("run_")}
    assert len(kernels) > 300
    assert {kernel: spilled for kernel, (_, spilled) in kernels.items() if spilled > 0} == {}
    records = "RecordList<[^<>]*>"
    particle_pass = re.compile(rf"run_groups<ParticlePass<.*, {records}, {records}, (\d), (\w+)<(.*)>>>$")
    most: dict[str, tuple[int, int]] = {}
    for kernel, numbers in kernels.items():
        found = particle_pass.match(kernel)
        if found:
            law = re.search(r"LinearElastic|MohrCoulomb<\w+>", found[3])
            name = f"{found[2]}{f' {law[0]}' if law else ''}, {found[1]}D"
            most[name] = max(numbers, most.get(name, numbers))
    limits = {f"{name}, {d}D": of[d - 2] for name, of in REGISTERS_OF_STEP.items() for d in (2, 3)}
    expect_within(limits, most)
