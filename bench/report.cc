#include "command.h"
namespace microlane {
void AddReport(CLI::App&) {}
}  // namespace microlane
