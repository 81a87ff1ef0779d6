// Short runs of the whole drive that several tests look at.

#ifndef STILLSPIN_TESTS_BENCH_DRIVE_RUNS_HPP
#define STILLSPIN_TESTS_BENCH_DRIVE_RUNS_HPP

#include <string_view>
#include <vector>

#include "sim_host/bench/run.hpp"

namespace stillspin::bench {

/// Profile `ideal` with the encoder as position source: nothing but the bench itself can be in the way.
RunRequest encoder_request(double duration);

/// Profile `bench`, so that noise is in every sample, likewise on the encoder.
RunRequest noisy_request(double duration, std::uint64_t seed);

/// A column of the record by its name.
const std::vector<double>& column(const RunResult& result, std::string_view name);

/// The first value of a column at or behind a time, s.
double at(const RunResult& result, std::string_view name, double when);

/// Largest position error between two times, degrees el.
double error_between(const RunResult& result, double begin, double end);

}  // namespace stillspin::bench

#endif
