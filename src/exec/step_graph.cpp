#include "exec/step_graph.hpp"

#if defined(BR_CUDA)
#include "exec/cuda.hpp"

namespace breccia {

struct StepGraph::Recorded {
  std::vector<ShadowLaunches::Launch> in_shadow;
  cudaGraphExec_t executable = nullptr;
  Recorded() = default;
  Recorded(const Recorded&) = delete;
  Recorded& operator=(const Recorded&) = delete;
  ~Recorded() {
    if (executable != nullptr) cudaGraphExecDestroy(executable);
  }
};

void StepGraph::begin() {
  check_device(cudaStreamBeginCapture(device_stream(), cudaStreamCaptureModeThreadLocal),
               "recording steps");
}

void StepGraph::end() {
  cudaGraph_t graph = nullptr;
  check_device(cudaStreamEndCapture(device_stream(), &graph), "recording steps");
  recorded().in_shadow.clear();
  cudaGraphExec_t& executable = recorded_->executable;
  // Launches with other arrays and counts update the graph: cheaper than a new instance.
  if (executable != nullptr) {
    cudaGraphExecUpdateResultInfo changed{};
    if (cudaGraphExecUpdate(executable, graph, &changed) != cudaSuccess) {
      cudaGetLastError();
      cudaGraphExecDestroy(executable);
      executable = nullptr;
    }
  }
  if (executable == nullptr)
    check_device(cudaGraphInstantiate(&executable, graph, 0), "preparing steps");
  cudaGraphDestroy(graph);
  stale_ = false;
}

void StepGraph::give_up() noexcept {
  cudaGraph_t graph = nullptr;
  if (cudaStreamEndCapture(device_stream(), &graph) == cudaSuccess) cudaGraphDestroy(graph);
  cudaGetLastError();  // the failure is told by what was thrown
}

void StepGraph::replay() const {
  if (replayed_in_shadow()) return;
  check_device(cudaGraphLaunch(recorded_->executable, device_stream()), "launching steps");
}

#else

namespace breccia {

struct StepGraph::Recorded {
  std::vector<ShadowLaunches::Launch> in_shadow;
};
void StepGraph::begin() {}
void StepGraph::end() {}
void StepGraph::give_up() noexcept {}
void StepGraph::replay() const {
  replayed_in_shadow();
}

#endif

StepGraph::Recorded& StepGraph::recorded() {
  if (!recorded_) recorded_ = std::make_unique<Recorded>();
  return *recorded_;
}
std::vector<ShadowLaunches::Launch>& StepGraph::emptied() {
  stale_ = true;
  recorded().in_shadow.clear();
  return recorded().in_shadow;
}
bool StepGraph::replayed_in_shadow() const {
  for (const ShadowLaunches::Launch& launch : recorded_->in_shadow)
    ShadowLaunches::add(launch.read_ahead, launch.work);
  return !recorded_->in_shadow.empty();
}

StepGraph::StepGraph() = default;
StepGraph::StepGraph(StepGraph&&) noexcept = default;
StepGraph& StepGraph::operator=(StepGraph&&) noexcept = default;
StepGraph::StepGraph(const StepGraph&) : StepGraph() {}
StepGraph& StepGraph::operator=(const StepGraph&) {
  recorded_.reset();
  stale_ = true;
  return *this;
}
StepGraph::~StepGraph() = default;

bool StepGraph::empty() const {
  return stale_;
}
void StepGraph::clear() {
  stale_ = true;
}

}  // namespace breccia
