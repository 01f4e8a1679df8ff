#!/usr/bin/env python3
"""edgeloc's matching beside what one would otherwise pick: same data, one process, one thread, interleaved.

    python3 benches/peers/peers.py            # makes a virtual environment below target/, builds, measures, prints

Every contestant computes, for each line of a scene and each view, the best Bhattacharyya coefficient with a line of the
view. The minimum of many rounds counts; each round gives every contestant a few runs in a row, the first of which warms
the caches. All answers are compared before anything is timed.
"""

import argparse
import ctypes
import os
import pathlib
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TARGET = pathlib.Path(os.environ.get("CARGO_TARGET_DIR") or ROOT / "target")
PACKAGES = ["numpy", "faiss-cpu", "simsimd", "numkong", "opencv-python-headless"]
THREADS = ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NK_NUM_THREADS"]
BODIES = ["SSE2", "AVX2", "AVX-512 VNNI"]

# How many times faster than a library, by its fastest way to all that is asked, each body is meant to be.
GOALS = [("NumPy", "SSE2", 2), ("NumPy", "AVX2", 5), ("NumPy", "AVX-512 VNNI", 6.5), ("FAISS", "AVX-512 VNNI", 15),
         ("NumKong i8", "AVX-512 VNNI", 2), ("OpenCV", "AVX-512 VNNI", 280)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=40, help="rounds; the least time of all counts [40]")
    parser.add_argument("--runs", type=int, default=3, help="runs of each contestant in a row [3]")
    parser.add_argument("--venv", type=pathlib.Path, default=TARGET / "peers-venv", help="virtual environment")
    arguments = parser.parse_args()
    python = arguments.venv / "bin" / "python"
    if pathlib.Path(sys.prefix).resolve() != arguments.venv.resolve():
        prepare(arguments.venv, python)
        environment = {name: value for name, value in os.environ.items() if name != "OPENBLAS_CORETYPE"}
        environment.update({name: "1" for name in THREADS})
        os.execve(python, [str(python), __file__, *sys.argv[1:]], environment)
    measure(arguments)


def prepare(venv, python):
    """The environment with the peers in it, and our library."""
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", venv], check=True)
    subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *PACKAGES], check=True)
    subprocess.run(["cargo", "build", "--release", "--locked", "--package", "edgeloc-peers"], cwd=ROOT, check=True)


class Ours:
    """The library, with the data that everybody matches."""

    def __init__(self, numpy):
        self.library = ctypes.CDLL(str(TARGET / "release" / "libedgeloc_peers.so"))
        self.library.edgeloc_limit_body.restype = ctypes.c_size_t
        self.library.edgeloc_peak.restype = ctypes.c_uint64
        sizes = numpy.zeros(5, numpy.uint32)
        self.library.edgeloc_sizes(pointer(sizes))
        self.scene_lines, self.views, self.view_lines, self.bins, self.pairs = map(int, sizes)
        self.scene = numpy.zeros((self.scene_lines, self.bins), numpy.int16)
        self.models = numpy.zeros((self.view_lines, self.bins), numpy.int16)
        self.lines = numpy.zeros(self.views, numpy.uint32)
        self.library.edgeloc_copy(pointer(self.scene), pointer(self.models), pointer(self.lines))
        self.best = numpy.zeros((self.views, self.scene_lines), numpy.int32)
        self.best_pointer = pointer(self.best)

    def limit_body(self, level):
        """Uses bodies up to the level; returns the name of the one that is left."""
        name = ctypes.c_void_p()
        length = self.library.edgeloc_limit_body(level, ctypes.byref(name))
        return ctypes.string_at(name, length).decode()

    def match(self, level):
        """A contestant: the best coefficients as floats, [view][scene line]."""
        if self.limit_body(level) != BODIES[level]:
            return None
        select = lambda: self.limit_body(level)
        return Contestant(f"edgeloc {BODIES[level]}", lambda: self.library.edgeloc_match(self.best_pointer),
                          lambda _: self.best / 2.0**30, 0.0, select)


class Contestant:
    """Something that finds the best coefficients."""

    def __init__(self, name, run, answer, tolerance, select=lambda: None, share=1.0, overhead=None):
        self.name, self.run, self.answer, self.tolerance, self.select = name, run, answer, tolerance, select
        self.share, self.overhead = share, overhead
        self.seconds, self.overhead_seconds = float("inf"), float("inf") if overhead else 0.0

    def time(self, runs):
        """Times some runs in a row; keeps the least."""
        self.select()
        for _ in range(runs):
            self.seconds = min(self.seconds, stopwatch(self.run))
        if self.overhead:
            self.overhead_seconds = min(self.overhead_seconds, stopwatch(self.overhead))

    def whole_seconds(self):
        """Of the whole work."""
        return (self.seconds - self.overhead_seconds) / self.share


def stopwatch(run):
    """Processor time of this thread, the only one: what others do on the machine is not counted."""
    start = time.thread_time()
    run()
    return time.thread_time() - start


def pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)


def contestants(ours):
    """Everybody, ours last."""
    import cv2
    import faiss
    import numkong
    import numpy
    import simsimd

    faiss.omp_set_num_threads(1)
    cv2.setNumThreads(1)
    scene = ours.scene.astype(numpy.float32) / 32768
    models = ours.models.astype(numpy.float32) / 32768
    ends = numpy.cumsum(ours.lines.astype(numpy.int64))
    starts = ends - ours.lines
    by_row = lambda product: numpy.maximum.reduceat(numpy.asarray(product), starts, axis=1).T
    by_column = lambda product: numpy.maximum.reduceat(numpy.asarray(product), starts, axis=0)
    # Eight bits: 127 is one.
    scene_8 = numpy.rint(ours.scene / 32768 * 127).astype(numpy.int8)
    models_8 = numpy.rint(ours.models / 32768 * 127).astype(numpy.int8)
    in_8 = lambda best: best / 127.0**2
    exact, eight_bits = 1e-5, 0.05

    def numpy_by_view():
        best = numpy.empty((ours.views, ours.scene_lines), numpy.float32)
        for view in range(ours.views):
            numpy.max(models[starts[view]:ends[view]] @ scene_t, axis=0, out=best[view])
        return best

    scene_t, models_t = numpy.ascontiguousarray(scene.T), models.T
    same = lambda best: best
    yield Contestant("NumPy matmul, max a view (rows)", lambda: by_row(scene @ models_t), same, exact)
    yield Contestant("NumPy matmul, max a view (columns)", lambda: by_column(models @ scene_t), same, exact)
    yield Contestant("NumPy matmul and max view by view", numpy_by_view, same, exact)
    yield Contestant("NumPy matmul alone", lambda: models @ scene_t, by_column, exact)

    flats = []
    for start, end in zip(starts, ends):
        flats.append(faiss.IndexFlatIP(ours.bins))
        flats[-1].add(models[start:end])
    yield Contestant("FAISS IndexFlatIP a view", lambda: [flat.search(scene, 1)[0][:, 0] for flat in flats],
                     numpy.array, exact)

    out_32 = numpy.zeros((ours.view_lines, ours.scene_lines), numpy.float32)

    def simsimd_f32():
        simsimd.cdist(models, scene, "dot", out=out_32, out_dtype="float32")
        return by_column(out_32)

    def simsimd_i8():
        simsimd.cdist(models_8, scene_8, "dot", out=out_32, out_dtype="float32")
        return by_column(out_32)

    yield Contestant("SimSIMD f32 cdist", simsimd_f32, same, exact)
    yield Contestant("SimSIMD i8 cdist", simsimd_i8, in_8, eight_bits)

    packed, packed_8 = numkong.dots_pack(models), numkong.dots_pack(models_8)
    scene_packed, scene_packed_8 = numkong.dots_pack(scene), numkong.dots_pack(scene_8)
    dots = numkong.dots_packed
    yield Contestant("NumKong f32 packed views", lambda: by_row(dots(scene, packed)), same, exact)
    yield Contestant("NumKong f32 packed scene", lambda: by_column(dots(models, scene_packed)), same, exact)
    yield Contestant("NumKong i8 packed views", lambda: by_row(dots(scene_8, packed_8)), in_8, eight_bits)
    yield Contestant("NumKong i8 packed scene", lambda: by_column(dots(models_8, scene_packed_8)), in_8, eight_bits)

    # OpenCV takes histograms, not roots, and gives the Hellinger distance, one pair a call: a few views are enough, and
    # what calls of one bin cost is taken off.
    some = min(2, ours.views)
    histograms, views = scene**2, models[:ends[some - 1]]**2
    bins = numpy.ones((1, 1), numpy.float32)
    compare, kind = cv2.compareHist, cv2.HISTCMP_BHATTACHARYYA
    distances = lambda: [[compare(view, own, kind) for own in histograms] for view in views]
    calls = lambda: [[compare(bins, bins, kind) for _ in histograms] for _ in views]

    def coefficients(distances):
        best = (1 - numpy.array(distances) ** 2) * numpy.sqrt(views.sum(1)[:, None] * histograms.sum(1)[None, :])
        return numpy.maximum.reduceat(best, starts[:some], axis=0)

    yield Contestant("OpenCV compareHist, calls taken off", distances, coefficients, 1e-4,
                     share=len(views) / ours.view_lines, overhead=calls)

    yield from filter(None, (ours.match(level) for level in range(len(BODIES))))


def check(everybody, ours):
    """Everybody gives the same answer; ours must be exact."""
    import numpy

    scene, models = ours.scene.astype(numpy.int64), ours.models.astype(numpy.int64)
    starts = numpy.cumsum(ours.lines.astype(numpy.int64)) - ours.lines
    expected = numpy.maximum.reduceat((models.astype(float) @ scene.T.astype(float)), starts, axis=0) / 2.0**30
    print(f"{'answers':<36} {'largest difference':>18}")
    for contestant in everybody:
        contestant.select()
        answer = numpy.asarray(contestant.answer(contestant.run()))
        difference = numpy.abs(answer - expected[:len(answer)]).max()
        print(f"{contestant.name:<36} {difference:18.2e}")
        if not difference <= contestant.tolerance:
            sys.exit(f"{contestant.name} differs by more than {contestant.tolerance}")


def measure(arguments):
    import numpy

    ours = Ours(numpy)
    products = ours.scene_lines * ours.view_lines
    density = ours.pairs / (ours.scene_lines * (ours.bins // 2))
    print(f"{ours.scene_lines} scene lines x {ours.views} views of {ours.view_lines} lines, {ours.bins} bins: "
          f"{products:,} coefficients")
    nonzero = numpy.count_nonzero(ours.scene) / ours.scene.size
    print(f"{nonzero:.1%} of the scene's bins and {density:.1%} of its pairs of bins are not empty\n")
    everybody = list(contestants(ours))
    check(everybody, ours)
    peaks, describing, naively = {}, {}, float("inf")
    levels = [level for level in range(len(BODIES)) if ours.limit_body(level) == BODIES[level]]
    for _ in range(arguments.rounds):
        for contestant in everybody:
            contestant.time(arguments.runs)
        for level in levels:
            ours.limit_body(level)
            took = min(stopwatch(ours.library.edgeloc_describe) for _ in range(20))
            describing[level] = min(describing.get(level, took), took)
            took = stopwatch(lambda: ours.library.edgeloc_peak(level))
            peaks[level] = max(peaks.get(level, 0.0), ours.library.edgeloc_peak(level) / took)
        naively = min(naively, stopwatch(ours.library.edgeloc_describe_naively))
    report(everybody, ours, products, density, peaks, levels)
    judge(everybody, levels)
    print(f"\nhistograms of the scene, {ours.scene_lines} lines, packed for matching; the naive twin {naively * 1e6:.0f} us")
    for level in levels:
        print(f"{BODIES[level]:<36} {describing[level] * 1e6:6.1f} us   {naively / describing[level]:5.1f} times the twin")
    kernels()


def judge(everybody, levels):
    """Goals and ratios."""
    whole = [contestant for contestant in everybody if not contestant.name.endswith("alone")]
    seconds = lambda beginning: min(other.whole_seconds() for other in whole if other.name.startswith(beginning))
    own = {contestant.name: contestant.whole_seconds() for contestant in everybody if "edgeloc" in contestant.name}
    print(f"\n{'faster than':<36} {'goal':>8} {'here':>8}")
    for beginning, body, goal in GOALS:
        if body in [BODIES[level] for level in levels]:
            print(f"{beginning + ', ' + body:<36} {goal:8} {seconds(beginning) / own['edgeloc ' + body]:8.2f}")


def report(everybody, ours, products, density, peaks, levels):
    numpys = [contestant for contestant in everybody if contestant.name.startswith("NumPy") and "max" in contestant.name]
    base = min(contestant.whole_seconds() for contestant in numpys)
    own = {contestant.name: contestant.whole_seconds() for contestant in everybody if "edgeloc" in contestant.name}
    bodies = [BODIES[level] for level in levels]
    print(f"\n{'':<36} {'ms':>8} {'ns a pair':>9} {'x NumPy':>8}   edgeloc is faster by, " + ", ".join(bodies))
    for contestant in everybody:
        seconds = contestant.whole_seconds()
        ratios = "  ".join(f"{seconds / own['edgeloc ' + body]:8.2f}" for body in bodies)
        print(f"{contestant.name:<36} {seconds * 1e3:8.2f} {seconds / products * 1e9:9.2f} {base / seconds:8.2f}   {ratios}")
    print(f"\n{'the machine`s limit':<36} {'GMAC/s':>8} {'dense ns':>9} {'sparse ns':>9}   share of the sparse limit reached")
    for level in levels:
        # A pair of lines is so many products when the scene's empty pairs of bins are skipped.
        dense = ours.bins / peaks[level] * 1e9
        share = dense * density / (own[f"edgeloc {BODIES[level]}"] / products * 1e9)
        name = "vpdpwssd" if level == 2 else "pmaddwd and paddd"
        print(f"{BODIES[level] + ', ' + name:<36} {peaks[level] / 1e9:8.0f} {dense:9.2f} {dense * density:9.2f}   {share:.0%}")


def kernels():
    """What ran, as everybody tells it."""
    import importlib.metadata as metadata

    import cv2
    import faiss
    import numkong
    import numpy
    import simsimd

    available = lambda capabilities: " ".join(name for name, there in capabilities.items() if there)
    config = numpy.show_config(mode="dicts")
    blas, simd = config["Build Dependencies"]["blas"], config["SIMD Extensions"]
    print("\nwhat ran")
    print("machine: " + next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if "model name" in line), "?")
          + f", load {os.getloadavg()[0]:.1f}")
    for package in PACKAGES:
        print(f"{package} {metadata.version(package)}")
    print(f"NumPy: {blas['name']} {blas['version']}, {blas.get('openblas configuration', '')}; found {simd.get('found')}")
    print(f"OpenBLAS kernel: {openblas_kernel()}")
    print(f"FAISS: {faiss.get_compile_options().strip()}; loaded {faiss_variant()}")
    print(f"SimSIMD: {available(simsimd.get_capabilities())}")
    print(f"NumKong: {available(numkong.get_capabilities())}")
    print(f"OpenCV: {cv2.getCPUFeaturesLine()}")


def openblas_kernel():
    """The name of the kernels that OpenBLAS chose, asked of the library that NumPy has loaded."""
    paths = {line.split()[-1] for line in open("/proc/self/maps") if "openblas" in line and "numpy" in line}
    for path in paths:
        library = ctypes.CDLL(path)
        for name in ("scipy_openblas_get_corename64_", "scipy_openblas_get_corename", "openblas_get_corename"):
            if hasattr(library, name):
                function = getattr(library, name)
                function.restype = ctypes.c_char_p
                return function().decode()
    return "unknown"


def faiss_variant():
    """The build of FAISS for this machine that its loader took."""
    names = {line.split()[-1].rsplit("/", 1)[-1] for line in open("/proc/self/maps") if "_swigfaiss" in line}
    return " ".join(sorted(names)) or "unknown"


if __name__ == "__main__":
    main()
