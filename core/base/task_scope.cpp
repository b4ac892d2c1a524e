#include "core/base/task_scope.h"

#include "core/base/error.h"

namespace orrery {
namespace {

// The initial-exec model avoids a function call per access.
[[gnu::tls_model("initial-exec")]] constinit thread_local TaskContext current_task;

}  // namespace

TaskScope::TaskScope(const TaskContext& work) : before_(std::exchange(current_task, work)) {}
TaskScope::~TaskScope() { current_task = before_; }
TaskContext TaskScope::current() { return current_task; }

MemoryCharge::MemoryCharge(std::size_t bytes) : account_(current_task.memory), bytes_(bytes) {
  if (account_) account_->add(bytes_);
}
MemoryCharge::~MemoryCharge() {
  if (account_) account_->remove(bytes_);
}

void checkpoint() {
  if (current_task.time_slice) current_task.time_slice->yield();
  if (current_task.stop && current_task.stop->stop_requested()) throw Cancelled();
  if (current_task.memory) current_task.memory->require_granted();
}

}  // namespace orrery
