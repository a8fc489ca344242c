// SPDX-License-Identifier: BSD-3-Clause
// An effect that is absent costs neither bytes nor allocations; nothing in a law or a batch allocates.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include "coulomb.hpp"
#include "rheology/advance.hpp"
#include "rheology/batch.hpp"
#include "rheology/laws.hpp"

using namespace grainlaw;

namespace {

/// How often anything was allocated by operator new in this program.
long allocations = 0;

void* counted(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size > 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  if (void* p = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)) return p;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void* operator new(std::size_t size, std::align_val_t a) { return counted(size, std::size_t(a)); }
void* operator new[](std::size_t size, std::align_val_t a) { return counted(size, std::size_t(a)); }
// Catch2 itself uses these two
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return ++allocations, std::malloc(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return ++allocations, std::malloc(size); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

// ---- bytes ----------------------------------------------------------------------------------------------------------

namespace {

/// What a person would write who has never heard of slots.
struct HandWritten {
  Constant c1, c2, c3, c4, p_floor;
};
using Full = HypoplasticBagnold<>;
using NoImpacts = HypoplasticBagnold<CriticalState, StressForm, NoCollisions>;
using Bare = HypoplasticBagnold<NoCriticalState, StressForm, NoCollisions>;

static_assert(sizeof(Bare) == sizeof(HandWritten), "slots that are off take no bytes");
static_assert(sizeof(Hypoplastic<NoCriticalState>) == sizeof(HandWritten));
static_assert(sizeof(NoImpacts) == sizeof(HandWritten) + sizeof(CriticalState));
static_assert(sizeof(Full) == sizeof(NoImpacts) + sizeof(Bagnold));
static_assert(sizeof(Full) == 120 && sizeof(NoImpacts) == 104 && sizeof(Bare) == 40);
// the form of the state is a choice of type, not of data
static_assert(sizeof(HypoplasticBagnold<CriticalState, LogForm>) == sizeof(Full));

template <class L>
constexpr bool no_history = std::is_empty_v<typename L::template State<double>>;
static_assert(no_history<Newtonian> && no_history<Bagnold> && no_history<example::Coulomb>);
template <class L>
constexpr bool six_numbers = sizeof(typename L::template State<double>) == 6 * sizeof(double) &&
                             sizeof(typename L::template State<PackF>) == 6 * sizeof(PackF);
static_assert(six_numbers<Full> && six_numbers<Bare> && six_numbers<Elastic> &&
              six_numbers<HypoplasticBagnold<CriticalState, LogForm>>);

/// Runs everything a host may call in its inner loop and returns how often that allocated.
template <class T, class L>
long allocations_of(const L& law) {
  constexpr std::size_t n = 37;  // packs and a tail
  constexpr int size = count<typename L::template State<T>, T>;
  std::vector<std::vector<T>> memory(std::size_t(10 + 2 * size + 6), std::vector<T>(n, T(0.01)));
  batch::FlowColumns<T> flows;
  batch::StateColumns<L, T> states, rates;
  batch::Columns<T, 6> stresses;
  std::size_t next = 0;
  for (auto& column : flows.at) column = memory[next++].data();
  for (auto& column : states.at) column = memory[next++].data();
  for (auto& column : rates.at) column = memory[next++].data();
  for (auto& column : stresses.at) column = memory[next++].data();
  const Flow<T> flow{{0, 0, 1, 0, 0, 0, 0, 0, 0}, T(0.01)};
  const SymTensor<T> sigma{-1000, -1000, -1000, 0, 0, 0};

  const long before = allocations;
  const auto y = law.start(flow, sigma);
  T sum = law.stress(flow, y).xx + law.wave_speed(flow, y, T(1600)) + law.viscosity(flow, y);
  [[maybe_unused]] const auto k = law.rate(flow, y);
  sum += T(law.admit(flow, y).reasons);
  law.observe(flow, y, [&](std::string_view, std::string_view, const T& x) { sum += x; });
  batch::rate<T>(law, flows, states, rates, n);
  batch::stress<T>(law, flows, states, stresses, n);
  sum += T(batch::admit<T>(law, flows, states, n)[0]);
  if constexpr (std::is_same_v<T, double>) sum += advance(law, flow, flow, y, 1e-3).rates;
  const long made = allocations - before;
  volatile T sink = sum;  // or the compiler would see that nobody looks at the results
  (void)sink;
  return made;
}

}  // namespace

TEST_CASE("operator new is counted") {
  const long before = allocations;
  const auto p = std::make_unique<double>(1.0);
  CHECK(allocations == before + 1);
  CHECK(*p == 1.0);
}

TEST_CASE("no law allocates, one point at a time or in batches") {
  for_each_recipe([]<class R>(R) {
    [&]<class... L>(std::tuple<L...>*) {
      const auto one = [&]<class Law>(Law law) {
        visit_parameters(law, [](const auto& row, Constant& v) { v = row.low > 0 ? row.low : row.high; });
        set_void_ratio(law, 0.8);
        INFO(R::name);
        const long in_double = allocations_of<double>(law), in_float = allocations_of<float>(law);
        CHECK(in_double == 0);
        CHECK(in_float == 0);
      };
      (one(L{}), ...);
    }(static_cast<typename R::Forms*>(nullptr));
  });
}
