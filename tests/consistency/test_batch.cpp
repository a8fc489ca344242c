// SPDX-License-Identifier: BSD-3-Clause
#include "harness.hpp"
#include "rheology/batch.hpp"

using namespace grainlaw;
using namespace grainlaw::consistency;

// This file is compiled twice. A compiler that fuses products and sums (the default of g++ where the processor can)
// fuses other pairs of them in a vector than in a scalar; each such choice is half a rounding of a term, and the
// formulas have ten to twenty in a row (measured: 3 in a rate, 7 in a mended state). Without fusing, scalar and pack
// agree to the last bit.
#if (defined(__FMA__) || defined(__FP_FAST_FMA)) && !defined(GRAINLAW_UNCONTRACTED)
constexpr double contraction_roundings = 15;
#else
constexpr double contraction_roundings = 0;
#endif

namespace {

/// Points in the columns that a host would have.
template <class L, class T>
struct Points {
  static constexpr int numbers_in_state = count<typename L::template State<T>, T>;
  std::size_t n;
  std::vector<std::vector<T>> flow, state, out, stress;
  explicit Points(std::size_t points)
      : n(points),
        flow(10, std::vector<T>(points)),
        state(std::size_t(numbers_in_state), std::vector<T>(points)),
        out(state),
        stress(6, std::vector<T>(points)) {}

  void set(std::size_t i, const Flow<T>& f, const typename L::template State<T>& y) {
    const auto l = numbers<T>(f.L);
    for (std::size_t k = 0; k < 9; ++k) flow[k][i] = l[k];
    flow[9][i] = f.compaction;
    const auto a = numbers<T>(y);
    for (std::size_t k = 0; k < a.size(); ++k) state[k][i] = a[k];
  }
  auto state_at(const std::vector<std::vector<T>>& columns, std::size_t i) const {
    std::array<T, std::size_t(numbers_in_state)> a{};
    for (std::size_t k = 0; k < a.size(); ++k) a[k] = columns[k][i];
    return from_numbers<typename L::template State<T>>(a);
  }
  SymTensor<T> stress_at(std::size_t i) const {
    return {stress[0][i], stress[1][i], stress[2][i], stress[3][i], stress[4][i], stress[5][i]};
  }
  batch::FlowColumns<T> flow_columns(std::size_t from = 0) const {
    batch::FlowColumns<T> c;
    for (std::size_t k = 0; k < 10; ++k) c.at[k] = flow[k].data() + from;
    return c;
  }
  batch::StateColumns<L, T> columns(std::vector<std::vector<T>>& of, std::size_t from = 0) const {
    batch::StateColumns<L, T> c;
    for (std::size_t k = 0; k < of.size(); ++k) c.at[k] = of[k].data() + from;
    return c;
  }
  batch::Columns<T, 6> stress_columns(std::size_t from = 0) {
    batch::Columns<T, 6> c;
    for (std::size_t k = 0; k < 6; ++k) c.at[k] = stress[k].data() + from;
    return c;
  }
};

template <class L, class T>
Points<L, T> random_points(const L& law, std::size_t n) {
  Points<L, T> points(n);
  Random random(71);
  for (std::size_t i = 0; i < n; ++i) {
    const Flow<T> flow = flow_in<T>(random.flow(1e-3, 1e3));
    const double fraction = random.below(8) == 0 ? random.uniform(0.9, 3) : random.uniform(0, 0.95);
    points.set(i, flow,
               law.start(Flow<T>{{}, flow.compaction}, sym_in<T>(random.stress(random.decades(1, 1e6), fraction))));
  }
  return points;
}

template <class L, class T>
void run(const L& law, Points<L, T>& p, std::size_t from, std::size_t n) {
  batch::rate<T>(law, p.flow_columns(from), p.columns(p.state, from), p.columns(p.out, from), n);
  batch::stress<T>(law, p.flow_columns(from), p.columns(p.state, from), p.stress_columns(from), n);
}

struct Difference {
  std::size_t differ = 0;
  double worst = 0;  ///< in roundings of the scale
};
template <class T, class X>
void compare(Difference& d, const X& a, const X& b, double scale) {
  const auto x = numbers<T>(a), y = numbers<T>(b);
  for (std::size_t k = 0; k < x.size(); ++k) {
    d.differ += x[k] != y[k];
    const double roundings =
        std::fabs(double(x[k]) - double(y[k])) / (scale * double(std::numeric_limits<T>::epsilon()));
    if (x[k] != y[k] && !(roundings <= d.worst)) d.worst = roundings;
  }
}

template <class L, class T>
void check_batch() {
  const L law = example_law<L>();
  constexpr std::size_t n = 20000;
  Points<L, T> points = random_points<L, T>(law, n);
  run(law, points, 0, n);

  SECTION("a point does not feel its neighbours, its place in the batch or the length of the batch") {
    for (std::size_t from : {std::size_t(0), std::size_t(1), std::size_t(6)}) {
      for (std::size_t length = 0; length <= 2 * pack_bytes / sizeof(T) + 1; ++length) {
        Points<L, T> part = points;
        for (auto& column : part.out) std::fill(column.begin(), column.end(), T(-77));
        for (auto& column : part.stress) std::fill(column.begin(), column.end(), T(-77));
        run(law, part, from, length);
        for (std::size_t i = 0; i < 64; ++i) {
          const bool inside = i >= from && i < from + length;
          for (std::size_t k = 0; k < part.out.size(); ++k) {
            HOLDS(part.out[k][i] == (inside ? points.out[k][i] : T(-77)));
          }
          for (std::size_t k = 0; k < 6; ++k) {
            HOLDS(part.stress[k][i] == (inside ? points.stress[k][i] : T(-77)));
          }
        }
      }
    }
  }

  SECTION("scalar and pack agree") {
    Difference rates, stresses, admitted;
    std::array<std::size_t, reason_names.size()> counted{};
    Points<L, T> mended = points;
    const auto fired = batch::admit<T>(law, mended.flow_columns(), mended.columns(mended.state), n);
    for (std::size_t i = 0; i < n; ++i) {
      std::array<T, 9> l;
      for (std::size_t k = 0; k < 9; ++k) l[k] = points.flow[k][i];
      const Flow<T> flow{from_numbers<Tensor<T>>(l), points.flow[9][i]};
      const auto y = points.state_at(points.state, i);
      // sizes in double: the state alone sets the size of a logarithmic one, and its rate is a strain rate
      const double of_stress = largest<T>(law.stress(flow, y)) + double(law.viscosity(flow, y)) * largest<T>(flow.L);
      const double c = double(law.wave_speed(flow, y, T(1))), g = largest<T>(flow.L);
      double modulus = c * c + of_stress;
      if constexpr (!StressInState<L> && Points<L, T>::numbers_in_state > 0) {
        modulus /= std::fabs(double(trace(law.stress(Flow<T>{{}, flow.compaction}, y))));
        modulus *= 1 + largest<T>(y);
      }
      compare<T>(rates, law.rate(flow, y), points.state_at(points.out, i), modulus * g);
      compare<T>(stresses, law.stress(flow, y), points.stress_at(i), of_stress);
      const auto a = law.admit(flow, y);
      compare<T>(admitted, a.state, mended.state_at(mended.state, i), largest<T>(y));
      for (std::size_t bit = 0; bit < counted.size(); ++bit) counted[bit] += (a.reasons >> bit) & 1;
    }
    CHECK(fired == counted);
    for (const Difference& d : {rates, stresses, admitted}) {
      CHECK(d.worst <= contraction_roundings);
      if (contraction_roundings == 0) CHECK(d.differ == 0);
    }
  }
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("a batch in double is the law point by point", "[batch]", AllLaws) {
  check_batch<TestType, double>();
}
TEMPLATE_LIST_TEST_CASE("a batch in float is the law point by point", "[batch]", AllLaws) {
  check_batch<TestType, float>();
}
