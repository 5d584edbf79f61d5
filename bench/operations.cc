#include "operations.h"

#include <cstdint>
#include <vector>

#if defined(__x86_64__) && defined(__linux__)
#include <ucontext.h>

#include <csignal>
#define MICROLANE_CAN_STEP 1
#else
#define MICROLANE_CAN_STEP 0
#endif

namespace microlane {
namespace {

// The encoding of an x86-64 vector instruction, as far as it tells what the instruction does.
struct Encoding {
  bool vector = false;
  bool evex = false, masked = false, wide = false;  // wide: W
  int map = 0, opcode = 0;                          // map 1: 0F, 2: 0F 38, 3: 0F 3A
  int prefix = 0;                                   // 0: none, 1: 66, 2: F3, 3: F2
  std::size_t bytes = 16;                           // of the registers
  bool memory = false;                              // the operand in ModRM is in memory
};

Encoding Decode(const std::uint8_t* code) {
  Encoding e;
  if (*code == 0x62) {
    e.vector = e.evex = true;
    e.map = code[1] & 7;
    e.wide = (code[2] & 0x80) != 0;
    e.prefix = code[2] & 3;
    e.opcode = code[4];
    e.memory = code[5] < 0xC0;
    e.masked = (code[3] & 7) != 0;
    const bool rounding = !e.memory && (code[3] & 0x10) != 0;
    e.bytes = rounding ? 64 : std::size_t{16} << ((code[3] >> 5) & 3);
    return e;
  }
  if (*code == 0xC5 || *code == 0xC4) {
    const bool three = *code == 0xC4;
    const std::uint8_t last = code[three ? 2 : 1];
    e.map = three ? code[1] & 31 : 1;
    e.wide = three && (last & 0x80) != 0;
    e.prefix = last & 3;
    e.bytes = (last & 4) != 0 ? 32 : 16;
    e.opcode = code[three ? 3 : 2];
    e.memory = code[three ? 4 : 3] < 0xC0;
    const bool general = (e.map == 2 && e.opcode >= 0xF2) || (e.map == 3 && e.opcode >= 0xF0);
    e.vector = !general && (e.map != 1 || e.opcode != 0x77);
    return e;
  }
  for (;; ++code) {
    if (*code == 0x66) {
      if (e.prefix == 0) e.prefix = 1;
    } else if (*code == 0xF3) {
      e.prefix = 2;
    } else if (*code == 0xF2) {
      e.prefix = 3;
    } else if ((*code & 0xF0) == 0x40) {
      e.wide = (*code & 8) != 0;
    } else {
      break;
    }
  }
  if (*code != 0x0F) return e;
  e.map = code[1] == 0x38 ? 2 : code[1] == 0x3A ? 3 : 1;
  code += e.map == 1 ? 1 : 2;
  e.opcode = code[0];
  e.memory = code[1] < 0xC0;
  e.vector = e.map == 2 ? e.opcode < 0xC8
             : e.map == 3
                 ? e.opcode < 0xCC
                 : (e.opcode >= 0x10 && e.opcode <= 0x17) || (e.opcode >= 0x28 && e.opcode <= 0x2F) ||
                       (e.opcode >= 0x50 && e.opcode <= 0x7F && e.opcode != 0x77) || e.opcode == 0xC2 ||
                       (e.opcode >= 0xC4 && e.opcode <= 0xC6) || e.opcode >= 0xD0;
  return e;
}

bool In(int x, int low, int high) { return x >= low && x <= high; }

enum class Move { kNone, kLoad, kStore, kRegister };

Move MoveOf(const Encoding& e) {
  if (e.map == 1) {
    const bool loads = e.opcode == 0x10 || e.opcode == 0x28 || e.opcode == 0x6F || e.opcode == 0x12 ||
                       e.opcode == 0x16 || e.opcode == 0x6E || (e.opcode == 0x7E && e.prefix == 2);
    const bool stores = e.opcode == 0x11 || e.opcode == 0x29 || e.opcode == 0x7F || e.opcode == 0x13 ||
                        e.opcode == 0x17 || e.opcode == 0x2B || e.opcode == 0x7E || e.opcode == 0xD6 ||
                        e.opcode == 0xE7;
    if (e.memory && loads) return Move::kLoad;
    if (e.memory && stores) return Move::kStore;
    const bool whole = e.opcode == 0x28 || e.opcode == 0x29 || e.opcode == 0x6F || e.opcode == 0x7F ||
                       ((e.opcode == 0x10 || e.opcode == 0x11) && e.prefix < 2);
    if (whole && !e.masked) return Move::kRegister;  // renamed, not executed
  }
  // Broadcasts from memory take no vector port.
  if (e.map == 2 && e.memory && (In(e.opcode, 0x18, 0x1B) || In(e.opcode, 0x58, 0x5B))) return Move::kLoad;
  return Move::kNone;
}

Unit UnitOf(const Encoding& e) {
  if (e.map == 1) {
    if (e.opcode == 0x5E) return Unit::kDivision;
    if (e.opcode == 0x51) return Unit::kRoot;
    if (e.opcode == 0x52) return Unit::kReciprocalRoot;
    if (e.opcode == 0x53) return Unit::kReciprocal;
    if (e.opcode == 0x59) return Unit::kMultiplication;
    if (In(e.opcode, 0x58, 0x5F) || In(e.opcode, 0x2A, 0x2F) || e.opcode == 0xC2 || e.opcode == 0xE6) {
      return Unit::kAddition;
    }
    if (e.evex && In(e.opcode, 0x78, 0x7B)) return Unit::kAddition;
  } else if (e.map == 2) {
    if (e.evex && In(e.opcode, 0x4C, 0x4D)) return Unit::kReciprocal;
    if (e.evex && In(e.opcode, 0x4E, 0x4F)) return Unit::kReciprocalRoot;
    if (In(e.opcode, 0x96, 0x9F) || In(e.opcode, 0xA6, 0xAF) || In(e.opcode, 0xB6, 0xBF))
      return Unit::kAddition;
    if (e.evex && (In(e.opcode, 0x2C, 0x2D) || In(e.opcode, 0x42, 0x43))) return Unit::kAddition;
  } else if (e.map == 3) {
    if (In(e.opcode, 0x08, 0x0B) || (e.evex && (In(e.opcode, 0x26, 0x27) || In(e.opcode, 0x50, 0x57)))) {
      return Unit::kAddition;
    }
  }
  return Unit::kLogic;
}

[[maybe_unused]] void Classify(const std::uint8_t* code, Operations& operations) {
  operations.all += 1;
  const Encoding e = Decode(code);
  if (!e.vector) return;
  const Move move = MoveOf(e);
  if (move == Move::kRegister) return;
  if (move == Move::kStore) {
    operations.stores += 1;
    return;
  }
  if (e.memory) operations.loads += 1;
  if (move == Move::kLoad) return;
  const Unit unit = UnitOf(e);
  // Map 1 tells the type by its prefix, the others by W; the low bit of an opcode of map 2 marks one number.
  const bool is_double = e.map == 1 ? e.prefix == 1 || e.prefix == 3 : e.wide;
  const bool single = unit != Unit::kLogic &&
                      ((e.map == 1 && e.prefix >= 2 && In(e.opcode, 0x51, 0x5F) && e.opcode != 0x5B) ||
                       (e.map == 2 && (e.opcode & 1) != 0 && e.opcode >= 0x4C));
  const std::size_t width = single ? 0 : e.bytes == 64 ? 3 : e.bytes == 32 ? 2 : 1;
  operations.vector[width][is_double][static_cast<std::size_t>(unit)] += 1;
}

#if MICROLANE_CAN_STEP
constexpr long long kTrapFlag = 0x100;
volatile bool stepping;
std::vector<const std::uint8_t*> trace;

void OnStep(int, siginfo_t*, void* context) {
  auto& registers = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  if (stepping && trace.size() < trace.capacity()) {
    registers[REG_EFL] |= kTrapFlag;
    trace.push_back(
        reinterpret_cast<const std::uint8_t*>(registers[REG_RIP]));  // NOLINT(performance-no-int-to-ptr)
  } else {
    registers[REG_EFL] &= ~kTrapFlag;
  }
}
#endif

}  // namespace

double Operations::Count(Unit unit) const {
  double sum = 0;
  for (const auto& width : vector) {
    for (const auto& type : width) sum += type[static_cast<std::size_t>(unit)];
  }
  return sum;
}

Operations& Operations::operator-=(const Operations& other) {
  for (std::size_t w = 0; w < kWidths; ++w) {
    for (std::size_t t = 0; t < 2; ++t) {
      for (std::size_t u = 0; u < kUnits; ++u) vector[w][t][u] -= other.vector[w][t][u];
    }
  }
  loads -= other.loads;
  stores -= other.stores;
  all -= other.all;
  return *this;
}

Operations& Operations::operator*=(double factor) {
  for (auto& width : vector) {
    for (auto& type : width) {
      for (double& count : type) count *= factor;
    }
  }
  loads *= factor;
  stores *= factor;
  all *= factor;
  return *this;
}

bool CanCountOperations() { return MICROLANE_CAN_STEP != 0; }

Operations CountOperations(const std::function<void()>& function) {
  Operations operations;
#if MICROLANE_CAN_STEP
  trace.clear();
  trace.reserve(std::size_t{1} << 20);
  struct sigaction action = {}, previous = {};
  action.sa_sigaction = OnStep;
  action.sa_flags = SA_SIGINFO;
  sigemptyset(&action.sa_mask);
  sigaction(SIGTRAP, &action, &previous);
  stepping = true;
  raise(SIGTRAP);
  function();
  stepping = false;  // the step after this finds it so and clears the flag
  sigaction(SIGTRAP, &previous, nullptr);
  for (const std::uint8_t* code : trace) Classify(code, operations);
#else
  function();
#endif
  return operations;
}

}  // namespace microlane
