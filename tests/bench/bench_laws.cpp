// SPDX-License-Identifier: BSD-3-Clause
// Nanoseconds per point of every law as a host would call it. Processor time, the best of many repetitions: on a
// machine with other users compare numbers of one run only.
//
//     bench_laws            everything
//     bench_laws --smoke    one repetition, to see that it runs
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <random>
#include <vector>

#include "rheology/batch.hpp"
#include "rheology/laws.hpp"

using namespace grainlaw;

namespace {

int repetitions = 25;
constexpr std::size_t points = 512;  // all columns in the first-level cache or close to it

double now() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}
/// Nanoseconds per point of f, which treats all points once.
template <class F>
double best(F&& f) {
  double least = 1e300;
  for (int k = 0; k < repetitions; ++k) {
    constexpr int inner = 60;
    const double start = now();
    for (int i = 0; i < inner; ++i) {
      f();
      asm volatile("" ::: "memory");
    }
    least = std::min(least, (now() - start) / inner / double(points) * 1e9);
  }
  return least;
}

// ---- laws -----------------------------------------------------------------------------------------------------------

/// What a person would write who has never heard of slots: hypoplastic, no density, no collisions.
struct HandDeleted {
  Constant c1, c2, c3, c4, p_floor;
  template <class R>
  struct State {
    SymTensor<R> sigma;
  };
  template <class R>
  SymTensor<R> stress(const Flow<R>&, const State<R>& y) const noexcept {
    return y.sigma;
  }
  template <class R>
  State<R> rate(const Flow<R>& flow, const State<R>& y) const noexcept {
    const SymTensor<R> D = symmetric(flow.L);
    const R tr = trace(y.sigma);
    const R inverse = real::select<R>(real::abs(tr) < real::tiny<R>(), R(0), R(1) / tr);
    const SymTensor<R> r = inverse * y.sigma, s = deviator(r);
    const R n = real::sqrt(contract(D, D));
    return {tr * (c1 * D + (c2 * contract(r, D)) * r + (n * c3.as<R>()) * square(r) + (n * c4.as<R>()) * square(s)) +
            spin_rate(flow.L, y.sigma)};
  }
  template <class R>
  Admitted<State<R>, R> admit(const Flow<R>& flow, const State<R>& y) const noexcept {
    using Slots = Hypoplastic<NoCriticalState>;
    const auto a =
        Slots{c1, c2, c3, c4, p_floor, {}}.template admit<R>(flow, typename Slots::template State<R>{y.sigma});
    return {{a.state.sigma}, a.reasons};
  }
};

/// Toyoura-like sand of undrained simple shear tests, dense enough to stay away from every correction.
template <class L>
L sand() {
  L law{};
  visit_parameters(law, [](const auto& row, Constant& value) {
    constexpr std::pair<std::string_view, double> values[] = {
        {"c1", -50.0}, {"c2", -629.6},   {"c3", -629.6},  {"c4", 1220.8}, {"p_floor", 1.0}, {"e_min", 0.597},
        {"p1", 0.53},  {"p2", 0.45},     {"p3", -1.8e-6}, {"q1", 1.0},    {"q2", -0.4},     {"q3", -1e-7},
        {"k_v", 0.01}, {"alpha_i", 0.6}, {"eta", 50.0},   {"K", 2e6},     {"G", 1e6}};
    for (const auto& [name, v] : values) {
      if (name == row.name) value = v;
    }
  });
  set_void_ratio(law, 0.845);
  return law;
}

// ---- points ---------------------------------------------------------------------------------------------------------

template <class L, class T>
struct Points {
  static constexpr int numbers = count<typename L::template State<T>, T>;
  static constexpr int columns = 10 + numbers + numbers + 6;
  // 28 columns at the same offset within a page would share one set of the cache
  static constexpr std::size_t stride = points + 128 / sizeof(T);
  std::vector<T> data;
  explicit Points(const L& law) : data(std::size_t(columns) * stride) {
    std::mt19937_64 engine(7);
    const auto u = [&] { return double(engine() >> 11) * 0x1p-52 - 1; };
    for (std::size_t i = 0; i < points; ++i) {
      Flow<T> flow{{T(u()), T(u()), T(u()), T(u()), T(u()), T(u()), T(u()), T(u()), T(u())}, T(0.02 * u())};
      const double p = 1e4 * (2 + u());
      SymTensor<T> sigma;
      int k = 0;
      // one point in a thousand pulls
      each(sigma, [&](T& x) { x = T(k++ < 3 ? -p * (1 + 0.3 * u()) : (i % 997 == 1 ? 0.9 : 0.2) * p * u()); });
      const auto y = start(law, sigma);
      each(flow.L, [&, c = 0](T& x) mutable { at(c++)[i] = x; });
      at(9)[i] = flow.compaction;
      if constexpr (numbers > 0) {
        T a[std::size_t(numbers)];
        std::memcpy(a, &y, sizeof y);
        for (int n = 0; n < numbers; ++n) at(10 + n)[i] = a[n];
      }
    }
  }
  static auto start(const L& law, const SymTensor<T>& sigma) {
    if constexpr (requires { law.start(Flow<T>{}, sigma); }) {
      return law.start(Flow<T>{}, sigma);
    } else {
      return typename L::template State<T>{sigma};
    }
  }
  T* at(int column) { return data.data() + std::size_t(column) * stride; }
  batch::FlowColumns<T> flow() {
    batch::FlowColumns<T> c;
    for (int k = 0; k < 10; ++k) c.at[std::size_t(k)] = at(k);
    return c;
  }
  batch::StateColumns<L, T> state(int first = 10) {
    batch::StateColumns<L, T> c;
    for (int k = 0; k < numbers; ++k) c.at[std::size_t(k)] = at(first + k);
    return c;
  }
  batch::StateColumns<L, T> out() { return state(10 + numbers); }
  batch::Columns<T, 6> stress() {
    batch::Columns<T, 6> c;
    for (int k = 0; k < 6; ++k) c.at[std::size_t(k)] = at(10 + 2 * numbers + k);
    return c;
  }
};

enum class What { rate, stress, all, midpoint };

/// One pass over all points, a double or a pack at a time; columns as in Points.
template <What what, class R, class L, class T>
[[gnu::noinline, gnu::flatten]] void pass(const L& shared, Points<L, T>& p) {
  using State = typename L::template State<R>;
  const L law = shared;
  const auto flows = p.flow();
  const auto states = p.state(), outs = p.out();
  const auto stresses = p.stress();
  const auto get = [](const T* x, std::size_t i) {
    if constexpr (RealTraits<R>::lanes == 1) {
      return x[i];
    } else {
      return R::load(x + i);
    }
  };
  const auto put = [](const R& x, T* to, std::size_t i) {
    if constexpr (RealTraits<R>::lanes == 1) {
      to[i] = x;
    } else {
      x.store(to + i);
    }
  };
  constexpr int n = Points<L, T>::numbers;
  using Numbers = std::array<R, std::size_t(n)>;
  const auto mix = [](const State& y, R h, const State& k) {
    if constexpr (n == 0) {
      return y;
    } else {
      Numbers a, b;
      std::memcpy(&a, &y, sizeof y);
      std::memcpy(&b, &k, sizeof k);
      for (std::size_t j = 0; j < std::size_t(n); ++j) a[j] = a[j] + h * b[j];
      State r;
      std::memcpy(&r, &a, sizeof r);
      return r;
    }
  };
  for (std::size_t i = 0; i < points; i += std::size_t(RealTraits<R>::lanes)) {
    Flow<R> flow;
    each(flow.L, [&, c = std::size_t(0)](R& x) mutable { x = get(flows.at[c++], i); });
    flow.compaction = get(flows.at[9], i);
    State y{};
    if constexpr (n > 0) {
      Numbers a;
      for (std::size_t j = 0; j < std::size_t(n); ++j) a[j] = get(states.at[j], i);
      std::memcpy(&y, &a, sizeof y);
    }
    State next = y;
    if constexpr (what == What::rate || what == What::all) next = law.rate(flow, y);
    if constexpr (what == What::midpoint) {
      const R h(T(1e-6));
      const State half = mix(y, R(T(0.5e-6)), law.rate(flow, y));
      next = law.admit(flow, mix(y, h, law.rate(flow, half))).state;
    }
    if constexpr (n > 0 && what != What::stress) {
      Numbers a;
      std::memcpy(&a, &next, sizeof next);
      for (std::size_t j = 0; j < std::size_t(n); ++j) put(a[j], outs.at[j], i);
    }
    if constexpr (what != What::rate) {
      SymTensor<R> sigma;
      if constexpr (what == What::stress) sigma = law.stress(flow, y);
      if constexpr (what == What::all) sigma = law.stress(flow, law.admit(flow, y).state);
      if constexpr (what == What::midpoint) sigma = law.stress(flow, next);
      each(sigma, [&, c = std::size_t(0)](const R& x) mutable { put(x, stresses.at[c++], i); });
    }
  }
}

/// The rate in a plain loop over columns that the compiler may vectorise by itself.
template <class L, class T>
[[gnu::noinline, gnu::flatten]] void plain_rate(const L& shared, Points<L, T>& p) {
  if constexpr (Points<L, T>::numbers == 6) {
    const L law = shared;
    const T* __restrict l0 = p.at(0);
    const T* __restrict l1 = p.at(1);
    const T* __restrict l2 = p.at(2);
    const T* __restrict l3 = p.at(3);
    const T* __restrict l4 = p.at(4);
    const T* __restrict l5 = p.at(5);
    const T* __restrict l6 = p.at(6);
    const T* __restrict l7 = p.at(7);
    const T* __restrict l8 = p.at(8);
    const T* __restrict c = p.at(9);
    const T* __restrict s0 = p.at(10);
    const T* __restrict s1 = p.at(11);
    const T* __restrict s2 = p.at(12);
    const T* __restrict s3 = p.at(13);
    const T* __restrict s4 = p.at(14);
    const T* __restrict s5 = p.at(15);
    T* __restrict r0 = p.at(16);
    T* __restrict r1 = p.at(17);
    T* __restrict r2 = p.at(18);
    T* __restrict r3 = p.at(19);
    T* __restrict r4 = p.at(20);
    T* __restrict r5 = p.at(21);
    for (std::size_t i = 0; i < points; ++i) {
      const T a[6] = {s0[i], s1[i], s2[i], s3[i], s4[i], s5[i]};
      typename L::template State<T> y;
      std::memcpy(&y, a, sizeof y);
      const auto k = law.rate(Flow<T>{{l0[i], l1[i], l2[i], l3[i], l4[i], l5[i], l6[i], l7[i], l8[i]}, c[i]}, y);
      T b[6];
      std::memcpy(b, &k, sizeof k);
      r0[i] = b[0], r1[i] = b[1], r2[i] = b[2], r3[i] = b[3], r4[i] = b[4], r5[i] = b[5];
    }
  }
}

template <class T, class L>
void line(const char* name, const L& law) {
  using P = batch::PackOf<T>;
  Points<L, T> p(law);
  constexpr bool history = Points<L, T>::numbers > 0;
  const char* type = sizeof(T) == 8 ? "double" : "float";
  std::printf("%-28s %-6s %7.2f %7.2f | ", name, type, history ? best([&] { pass<What::rate, T>(law, p); }) : 0.0,
              best([&] { pass<What::stress, T>(law, p); }));
  std::printf("%7.2f %7.2f | ",
              history ? best([&] { batch::rate<T>(law, p.flow(), p.state(), p.out(), points); }) : 0.0,
              history ? best([&] { plain_rate(law, p); }) : 0.0);
  std::printf("%7.2f %7.2f %8.2f %8.2f\n", best([&] { pass<What::stress, P>(law, p); }),
              best([&] { pass<What::all, P>(law, p); }), best([&] { pass<What::midpoint, P>(law, p); }),
              best([&] { pass<What::midpoint, T>(law, p); }));
  std::fflush(stdout);
}

/// Two versions in turns, so that a slow second hits both.
template <class F, class G>
void ratio(const char* name, F&& f, G&& g) {
  double a = 1e300, b = 1e300;
  const int turns = repetitions > 1 ? 10 : 1;
  for (int k = 0; k < turns; ++k) {
    a = std::min(a, best(f));
    b = std::min(b, best(g));
  }
  std::printf("  %-28s %7.2f %7.2f   ratio %.3f\n", name, a, b, a / b);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "--smoke") repetitions = 1;
  const auto full = sand<HypoplasticBagnold<>>();
  const auto no_collisions = sand<HypoplasticBagnold<CriticalState, StressForm, NoCollisions>>();
  const auto off = sand<HypoplasticBagnold<NoCriticalState, StressForm, NoCollisions>>();
  const HandDeleted hand{off.skeleton.c1, off.skeleton.c2, off.skeleton.c3, off.skeleton.c4, off.skeleton.p_floor};
  const auto logarithmic = sand<HypoplasticBagnold<CriticalState, LogForm>>();

  std::printf("bytes: hypoplastic_bagnold %zu, without collisions %zu, without critical state too %zu, by hand %zu\n\n",
              sizeof full, sizeof no_collisions, sizeof off, sizeof hand);
  std::printf(
      "ns per point                           scalar          |   rate in a batch | batch of packs             "
      "scalar\n");
  std::printf(
      "law                          Real      rate  stress |    pack   plain |  stress     all midpoint midpoint\n");
  line<double>("hypoplastic_bagnold", full);
  line<double>("  collisions off", no_collisions);
  line<double>("  critical state off too", off);
  line<double>("  deleted by hand", hand);
  line<double>("  logarithmic form", logarithmic);
  line<double>("elastic", sand<Elastic>());
  line<double>("newtonian", sand<Newtonian>());
  line<double>("bagnold", sand<Bagnold>());
  line<float>("hypoplastic_bagnold", full);
  line<float>("  critical state off too", off);
  line<float>("  deleted by hand", hand);
  line<float>("elastic", sand<Elastic>());
  line<float>("newtonian", sand<Newtonian>());

  std::printf("\nslots off against code without them, in turns\n");
  using Off = std::remove_const_t<decltype(off)>;
  Points<Off, double> a(off);
  Points<HandDeleted, double> b(hand);
  using P = batch::PackOf<double>;
  ratio(
      "rate, scalar", [&] { pass<What::rate, double>(off, a); }, [&] { pass<What::rate, double>(hand, b); });
  ratio(
      "rate, batch", [&] { batch::rate<double>(off, a.flow(), a.state(), a.out(), points); },
      [&] { batch::rate<double>(hand, b.flow(), b.state(), b.out(), points); });
  ratio(
      "rate, plain loop", [&] { plain_rate(off, a); }, [&] { plain_rate(hand, b); });
  ratio(
      "rate + stress + admit, packs", [&] { pass<What::all, P>(off, a); }, [&] { pass<What::all, P>(hand, b); });
  ratio(
      "midpoint step, packs", [&] { pass<What::midpoint, P>(off, a); }, [&] { pass<What::midpoint, P>(hand, b); });
}
