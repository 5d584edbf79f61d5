// `microlane cavities`: light inside V-cavities (Meneveaux 2015 section 3.3), on all cores.
#include "cavities.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "cavity_picture.h"
#include "command.h"
#include "microlane/scalar/beckmann.h"
#include "microlane/scalar/ggx.h"
#include "microlane/scalar/v_cavity.h"
#include "microlane/targets.h"
#include "microlane/v_cavity.h"
#include "plots.h"

namespace microlane {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kPi = 3.14159265358979323846;
constexpr std::uint64_t kBlock = std::uint64_t{1} << 16;  // paths a task
constexpr int kInterrupted = 130;

struct Request {
  std::string distribution = "ggx", facets = "interfaced", csv, picture, target;
  double alpha = 0.5, ratio = 1, n = 1.5, k = 0.8, theta = 30, phi = 0, paths = 1e7, seconds = 0.2;
  std::uint64_t rows = 36, columns = 90, orders = 4;
  std::uint32_t seed = 0, max_bounces = 0, threads = 0;
};

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

// A second interrupt ends the program.
void Interrupt(int) {
  interrupted.store(true, std::memory_order_relaxed);
  std::signal(SIGINT, SIG_DFL);
}

VCavityTotals TraceLanes(const Request& request, const VCavityScene& scene, std::uint64_t first,
                         std::uint64_t count, std::uint64_t* counts) {
  return request.distribution == "ggx" ? v_cavity::Trace(scene, first, count, counts)
                                       : v_cavity_beckmann::Trace(scene, first, count, counts);
}

VCavityTotals TraceScalar(const Request& request, const VCavityScene& scene, std::uint64_t first,
                          std::uint64_t count, std::uint64_t* counts) {
  return request.distribution == "ggx"
             ? scalar::VCavity<scalar::Ggx, float>(scene).Trace(first, count, counts)
             : scalar::VCavity<scalar::Beckmann, float>(scene).Trace(first, count, counts);
}

// Says how far a run is: on a terminal in one line each second, elsewhere in a new line every 10.
class Progress {
 public:
  explicit Progress(std::uint64_t paths) : paths_(paths) {}
  ~Progress() {
    if (printed_ && terminal_) std::fprintf(stderr, "\n");
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void Add(std::uint64_t paths, std::uint64_t hits) {
    const std::uint64_t done = done_.fetch_add(paths) + paths, met = hits_.fetch_add(hits) + hits;
    const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock()) return;
    const Clock::time_point now = Clock::now();
    if (now - last_ < std::chrono::seconds(terminal_ ? 1 : 10)) return;
    last_ = now;
    printed_ = true;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double share = static_cast<double>(done) / static_cast<double>(paths_);
    fmt::print(stderr, "{}{:5.1f} % of {:g} paths, {:.1f} million facet hits/s, {:.0f} s left{}",
               terminal_ ? "\r" : "", 100 * share, static_cast<double>(paths_),
               static_cast<double>(met) / seconds * 1e-6, seconds * (1 - share) / share,
               terminal_ ? "  " : "\n");
    std::fflush(stderr);
  }

 private:
  std::uint64_t paths_;
  std::atomic<std::uint64_t> done_{0}, hits_{0};
  std::mutex mutex_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
  const bool terminal_ = isatty(STDERR_FILENO) == 1;
  bool printed_ = false;
};

CavityResult Simulate(const Request& request, const VCavityScene& scene, std::uint64_t paths, int threads) {
  const std::size_t size = VCavityCounts(scene);
  struct Part {
    std::vector<std::uint64_t> counts;
    VCavityTotals totals;
    std::uint64_t paths = 0;
  };
  tbb::enumerable_thread_specific<Part> parts([&] { return Part{std::vector<std::uint64_t>(size), {}, 0}; });
  Progress progress(paths);
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  const std::uint64_t blocks = (paths + kBlock - 1) / kBlock;
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::uint64_t>(0, blocks),
        [&](const tbb::blocked_range<std::uint64_t>& range) {
          Part& part = parts.local();
          for (std::uint64_t block = range.begin(); block != range.end(); ++block) {
            if (interrupted.load(std::memory_order_relaxed)) return;
            const std::uint64_t first = block * kBlock, count = std::min(kBlock, paths - first);
            const VCavityTotals totals = TraceLanes(request, scene, first, count, part.counts.data());
            part.totals.hits += totals.hits;
            part.totals.absorbed += totals.absorbed;
            part.totals.cut += totals.cut;
            part.paths += count;
            progress.Add(count, totals.hits);
          }
        },
        tbb::simple_partitioner());
  });
  CavityResult result{scene, std::vector<std::uint64_t>(size), {}, 0};
  for (const Part& part : parts) {
    for (std::size_t i = 0; i < size; ++i) result.counts[i] += part.counts[i];
    result.totals.hits += part.totals.hits;
    result.totals.absorbed += part.totals.absorbed;
    result.totals.cut += part.totals.cut;
    result.paths += part.paths;
  }
  return result;
}

double ThreadSeconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Lanes and scalar in turn.
CavitySpeed MeasureSpeed(const Request& request, const VCavityScene& scene) {
  std::vector<std::uint64_t> counts(VCavityCounts(scene));
  const auto rate = [&](const auto& trace, std::uint64_t count) {
    const double start = ThreadSeconds();
    const VCavityTotals totals = trace(request, scene, 0, count, counts.data());
    return static_cast<double>(totals.hits) / (ThreadSeconds() - start);
  };
  CavitySpeed speed;
  const double start = ThreadSeconds();
  do {
    speed.lanes = std::max(speed.lanes, rate(TraceLanes, 1 << 17));
    speed.scalar = std::max(speed.scalar, rate(TraceScalar, 1 << 14));
  } while (ThreadSeconds() - start < request.seconds);
  return speed;
}

void PrintShare(const std::string& name, std::uint64_t count, std::uint64_t paths) {
  const double n = static_cast<double>(paths), share = static_cast<double>(count) / n;
  fmt::print("{:<24} {:>10.6f} {:>9.1e}\n", name, share, std::sqrt(share * (1 - share) / n));
}

void Print(const CavityResult& result) {
  fmt::print("{:<24} {:>10} {:>9}\n", "", "energy", "+-");
  std::uint64_t left = 0;
  for (std::size_t order = 0; order < result.scene.orders; ++order) {
    const std::uint64_t sum = CountOfHits(result, order);
    left += sum;
    const std::string name = HitsName(result.scene, order);
    PrintShare(fmt::format("after {} {}", name, name == "1" ? "hit" : "hits"), sum, result.paths);
  }
  PrintShare("all that leaves", left, result.paths);
  PrintShare("absorbed", result.totals.absorbed, result.paths);
  if (result.scene.max_hits != 0) PrintShare("cut by --max-bounces", result.totals.cut, result.paths);
  fmt::print("{:<24} {:>10.6f}\n", "facet hits a path",
             static_cast<double>(result.totals.hits) / static_cast<double>(result.paths));
}

VCavityScene SceneOf(const Request& request) {
  VCavityScene scene;
  scene.alpha_x = request.alpha;
  scene.alpha_y = request.alpha * request.ratio;
  scene.facets = request.facets == "mirror" ? VCavityFacets::kMirror : VCavityFacets::kInterfaced;
  scene.n_i = request.n;
  scene.k = request.k;
  const double theta = request.theta * (kPi / 180), phi = request.phi * (kPi / 180);
  scene.wi[0] = std::sin(theta) * std::cos(phi);
  scene.wi[1] = std::sin(theta) * std::sin(phi);
  scene.wi[2] = std::cos(theta);
  scene.rows = request.rows;
  scene.columns = request.columns;
  scene.orders = request.orders;
  scene.seed = request.seed;
  scene.max_hits = request.max_bounces;
  return scene;
}

std::string Title(const Request& request) {
  const std::string facets = request.facets == "mirror"
                                 ? std::string("mirrors")
                                 : fmt::format("interfaced facets, n = {:g}, k = {:g}", request.n, request.k);
  return fmt::format("{}, alpha {:g}{}, {}, {:g} degrees", request.distribution == "ggx" ? "GGX" : "Beckmann",
                     request.alpha,
                     request.ratio == 1 ? "" : fmt::format(" and {:g}", request.alpha * request.ratio),
                     facets, request.theta);
}

void Run(const Request& request, int& exit_code) {
  UseTarget(request.target);
  const VCavityScene scene = SceneOf(request);
  const std::string error = VCavityError(scene);
  if (!error.empty()) Fail(error);
  if (request.paths != std::floor(request.paths)) {
    Fail(fmt::format("--paths: {} is no whole number", request.paths));
  }
  if (!request.picture.empty()) {
    if (PictureTerminal(request.picture).empty()) {
      Fail(fmt::format("--picture: '{}' ends neither in .svg nor in .png", request.picture));
    }
    if (!HasGnuplot()) Fail("--picture: there is no gnuplot to draw it");
  }
  std::ofstream csv;
  if (!request.csv.empty()) {
    csv.open(request.csv);
    if (!csv) Fail(fmt::format("--csv: cannot write '{}'", request.csv));
  }
  const int threads =
      request.threads != 0 ? static_cast<int>(request.threads) : tbb::info::default_concurrency();

  std::signal(SIGINT, Interrupt);
  const Clock::time_point start = Clock::now();
  const CavityResult result = Simulate(request, scene, static_cast<std::uint64_t>(request.paths), threads);
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const bool stopped = interrupted.load();
  std::signal(SIGINT, SIG_DFL);
  if (result.paths == 0) Fail("interrupted before any path was traced");

  const std::string title = Title(request);
  fmt::print("V-cavities of {}: {} paths{}\n", title, result.paths, stopped ? ", interrupted" : "");
  Print(result);
  fmt::print("\ntarget {}, {} {}: {:.2f} s, {:.1f} million facet hits a second\n", ChosenTarget(), threads,
             threads == 1 ? "thread" : "threads", seconds,
             static_cast<double>(result.totals.hits) / seconds * 1e-6);
  if (!stopped && request.seconds > 0) {
    const CavitySpeed speed = MeasureSpeed(request, scene);
    fmt::print("one core: {:.1f} million facet hits a second in lanes, {:.2f} scalar, {:.1f} times\n",
               speed.lanes * 1e-6, speed.scalar * 1e-6, speed.lanes / speed.scalar);
  }
  if (csv.is_open()) {
    WriteCavityCsv(result, title, csv);
    csv.close();
    if (!csv) Fail(fmt::format("--csv: cannot write '{}'", request.csv));
  }
  if (!request.picture.empty()) {
    const std::string drawing = DrawCavities(result, title, request.distribution == "ggx", request.picture);
    if (!drawing.empty()) Fail(fmt::format("--picture: {}", drawing));
  }
  if (stopped) exit_code = kInterrupted;
}

}  // namespace

std::vector<CavityFigure> MeasureCavities(std::uint64_t paths) {
  std::vector<CavityFigure> figures;
  const auto measure = [&](const char* facets, double n, double k) {
    Request request;
    request.facets = facets;
    request.alpha = 0.8;
    request.n = n;
    request.k = k;
    const VCavityScene scene = SceneOf(request);
    figures.push_back({Title(request), request.distribution == "ggx",
                       Simulate(request, scene, paths, tbb::info::default_concurrency()),
                       MeasureSpeed(request, scene)});
  };
  measure("interfaced", 1, 1);
  measure("interfaced", 1.5, 0.8);
  measure("interfaced", 1.5, 0);
  measure("mirror", 1, 0);
  return figures;
}

void AddCavities(CLI::App& app, int& exit_code) {
  CLI::App* cavities =
      app.add_subcommand("cavities", "Simulate light that goes from facet to facet in V-cavities");
  auto request = std::make_shared<Request>();
  cavities->add_option("--distribution", request->distribution, "ggx or beckmann (the default: ggx)")
      ->check(CLI::IsMember({"ggx", "beckmann"}));
  cavities->add_option("--alpha", request->alpha, "Roughness along x (the default: 0.5)");
  cavities->add_option("--ratio", request->ratio, "alpha_y over alpha_x (the default: 1)");
  cavities->add_option("--facets", request->facets, "mirror or interfaced (the default: interfaced)")
      ->check(CLI::IsMember({"mirror", "interfaced"}));
  cavities->add_option("-n", request->n, "Index of the body, 1 for Lambertian facets (the default: 1.5)");
  cavities->add_option("-k", request->k, "Albedo of the body (the default: 0.8)");
  cavities->add_option("--theta", request->theta, "Light's degrees from the normal (the default: 30)")
      ->check(CLI::Range(0.0, 89.9999));
  cavities->add_option("--phi", request->phi, "Light's azimuth in degrees (the default: 0)")
      ->check(CLI::Range(-360.0, 360.0));
  cavities->add_option("--paths", request->paths, "How many (the default: 1e7)")
      ->check(CLI::Range(1.0, 0x1p53));
  cavities->add_option("--seed", request->seed, "Of the random numbers (the default: 0)")
      ->check(RefuseNegative);
  cavities->add_option("--threads", request->threads, "How many; 0: as the machine has (the default)")
      ->check(CLI::Range(0, 1024));
  cavities->add_option("--max-bounces", request->max_bounces, "End longer paths; 0: none (the default)")
      ->check(RefuseNegative);
  cavities->add_option("--rows", request->rows, "Of cells, from the horizon up (the default: 36)")
      ->check(RefuseNegative);
  cavities->add_option("--columns", request->columns, "Of cells, around (the default: 90)")
      ->check(RefuseNegative);
  cavities
      ->add_option("--orders", request->orders,
                   "Numbers of hits told apart, the last with all above it (the default: 4)")
      ->check(RefuseNegative);
  cavities->add_option("--csv", request->csv, "A file for the cells");
  cavities->add_option("--picture", request->picture, "A file, .svg or .png, drawn by gnuplot");
  cavities->add_option("--target", request->target,
                       "An instruction set of this machine (the default: the best)");
  cavities
      ->add_option("--seconds", request->seconds,
                   "How long to measure the speed of one core; 0: not at all (the default: 0.2)")
      ->check(RefuseNegative);
  cavities->footer(
      "Counts depend on the scene, the seed and the number of paths, not on threads. An interrupt ends the "
      "run;\n"
      "what was traced is printed and written, and the exit code is 130. Columns of the CSV: hits (1, 2, "
      "...,\n"
      "the last with all above it, all); row and column of the cell; its bounds in cos(theta) and in degrees "
      "of\n"
      "azimuth; the paths that left through it; f, the BRDF's mean over the cell by the cosine, in 1/sr; and "
      "its\n"
      "standard error.");
  cavities->callback([request, &exit_code] { Run(*request, exit_code); });
}

}  // namespace microlane
