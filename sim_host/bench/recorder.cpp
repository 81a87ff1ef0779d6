#include "sim_host/bench/recorder.hpp"

#include <cmath>
#include <limits>

#include "firmware/drive/signals.h"

namespace stillspin::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRpmPerRads = 30.0 / kPi;

struct Row {
  double time;
  const plant::PlantState& p;
  const drive_signals_t& f;
  const Information& told;
};

// In user's units.
double scaled(std::int32_t raw, int q, unit_t unit = UNIT_NONE) {
  return std::ldexp(static_cast<double>(raw), unit_exponent(static_cast<std::uint16_t>(unit)) - q);
}
double radians(std::int32_t bam) { return scaled(bam, 31) * kPi; }

// What is said of the rotor is no number while the drive does not know its angle.
double known(const Row& r, double value) {
  return r.f.speed_known != 0 ? value : std::numeric_limits<double>::quiet_NaN();
}

struct Column {
  ColumnInfo info;
  double (*value)(const Row&);
  int place = -1;  // of a signal that not every edition has
};

#define SIGNAL(name, unit, q, of, value, meaning) kPlace_##name,
enum Place {
#include "firmware/dictionary/all_signals.h"
};
#undef SIGNAL

bool is_here(const Column& c) { return c.place < 0 || !signal_is_left_out(static_cast<std::uint16_t>(c.place)); }

// Names, units and meaning of the record; the firmware's own part follows firmware/dictionary/signal_list.h.
const Column kColumns[] = {
    {{"time", "s", "0 is the end of the start procedure"}, [](const Row& r) { return r.time; }},
    {{"true_angle", "rad", "electrical rotor angle"}, [](const Row& r) { return r.p.angle_e; }},
    {{"est_angle", "rad", "electrical angle that the controller used"},
     [](const Row& r) { return known(r, radians(r.f.angle)); }},
    {{"true_speed", "rpm", "shaft speed"}, [](const Row& r) { return r.p.speed_m * kRpmPerRads; }},
    {{"est_speed", "rpm", "speed that the controller used"},
     [](const Row& r) { return known(r, scaled(r.f.speed, 16)); }},
    {{"speed_ref", "rpm", "speed reference after its ramp"},
     [](const Row& r) { return scaled(r.f.speed_reference, 16); }},
    {{"torque", "Nm", "air-gap torque"}, [](const Row& r) { return r.p.torque; }},
    {{"load_torque", "Nm", "load torque"}, [](const Row& r) { return r.p.load; }},
    {{"i_a", "A", "current of phase a"}, [](const Row& r) { return r.p.current[0]; }},
    {{"i_b", "A", "current of phase b"}, [](const Row& r) { return r.p.current[1]; }},
    {{"i_c", "A", "current of phase c"}, [](const Row& r) { return r.p.current[2]; }},
    {{"true_i_d", "A", "d-axis current at the period's start"}, [](const Row& r) { return r.p.current_d; }},
    {{"true_i_q", "A", "q-axis current at the period's start"}, [](const Row& r) { return r.p.current_q; }},
    {{"i_d", "A", "d-axis current as measured"},
     [](const Row& r) { return known(r, scaled(r.f.current_d, 20, UNIT_A)); }},
    {{"i_q", "A", "q-axis current as measured"},
     [](const Row& r) { return known(r, scaled(r.f.current_q, 20, UNIT_A)); }},
    {{"i_d_ref", "A", "d-axis current reference"},
     [](const Row& r) { return scaled(r.f.current_d_reference, 20, UNIT_A); }},
    {{"i_q_ref", "A", "q-axis current reference"},
     [](const Row& r) { return scaled(r.f.current_q_reference, 20, UNIT_A); }},
    {{"v_d", "V", "d-axis voltage command"}, [](const Row& r) { return scaled(r.f.voltage_d, 16, UNIT_V); }},
    {{"v_q", "V", "q-axis voltage command"}, [](const Row& r) { return scaled(r.f.voltage_q, 16, UNIT_V); }},
    {{"v_alpha", "V", "alpha-axis mean voltage for the next period"},
     [](const Row& r) { return scaled(r.f.voltage_alpha, 16, UNIT_V); }},
    {{"v_beta", "V", "beta-axis mean voltage for the next period"},
     [](const Row& r) { return scaled(r.f.voltage_beta, 16, UNIT_V); }},
    {{"v_link", "V", "DC-link voltage as measured"}, [](const Row& r) { return scaled(r.f.link_voltage, 16, UNIT_V); }},
    {{"deviation_q", "A/s", "q-axis current deviation under zero vectors (D of the paper)"},
     [](const Row& r) { return known(r, scaled(r.f.deviation_q, 8, UNIT_A_PER_S)); }},
    {{"v_dc", "V", "DC-link voltage"}, [](const Row& r) { return r.p.link_voltage; }},
    {{"angle_zvv", "rad", "electrical angle of the low-speed estimator"},
     [](const Row& r) { return known(r, radians(r.f.angle_low)); }},
    {{"angle_avv", "rad", "electrical angle of the AVV estimator"},
     [](const Row& r) { return known(r, radians(r.f.angle_avv)); }},
    {{"weight", "", "share of the low-speed estimator"}, [](const Row& r) { return r.f.weight / 32767.0; }},
    {{"load_estimate", "Nm", "estimated load torque, friction included"},
     [](const Row& r) { return known(r, scaled(r.f.load_torque, 16, UNIT_NM)); }},
    {{"state", "", "state of the drive"}, [](const Row& r) { return static_cast<double>(r.f.state); }},
    {{"fault", "", "latched fault"}, [](const Row& r) { return static_cast<double>(r.f.fault); }},
    {{"start_phase", "", "phase of the start"}, [](const Row& r) { return static_cast<double>(r.f.start_phase); }},
    {{"polarity_sigma", "", "confidence in the polarity found at the start, standard errors"},
     [](const Row& r) { return scaled(r.f.polarity_sigma, 8); }},
    {{"limit", "", "active limits, bits"}, [](const Row& r) { return static_cast<double>(r.f.limit); }},
    {{"true_load_angle", "rad", "angle of the stator flux ahead of the d-axis"},
     [](const Row& r) { return std::atan2(r.p.flux_q, r.p.flux_d); }},
    {{"load_angle", "rad", "angle of the stator flux ahead of the d-axis, as estimated"},
     [](const Row& r) { return known(r, radians(r.f.load_angle)); },
     kPlace_load_angle},
    {{"magnet_flux", "Vs", "magnet flux as the stator-flux sources estimate it"},
     [](const Row& r) { return scaled(r.f.magnet_flux, 16, UNIT_MVS) * 1e-3; },
     kPlace_magnet_flux},
    {{"told_angle", "1/rad^2", "Fisher information of the last period's windows about the electrical angle"},
     [](const Row& r) { return r.told.angle; }},
    {{"told_cross", "s/rad^2",
      "Fisher information of the last period's windows, cross term of angle and electrical speed"},
     [](const Row& r) { return r.told.cross; }},
    {{"told_speed", "s^2/rad^2", "Fisher information of the last period's windows about the electrical speed"},
     [](const Row& r) { return r.told.speed; }},
};

}  // namespace

const std::vector<ColumnInfo>& columns() {
  static const std::vector<ColumnInfo> list = [] {
    std::vector<ColumnInfo> all;
    for (const Column& c : kColumns) {
      if (is_here(c)) all.push_back(c.info);
    }
    return all;
  }();
  return list;
}

Recorder::Recorder(int every, const plant::PlantConfig& config)
    : information_(config), every_(every), values_(columns().size()) {}

void Recorder::reserve(std::size_t rows) {
  for (auto& column : values_) column.reserve(rows);
}

void Recorder::begin_row(double time, const plant::Plant& plant) {
  open_ = skipped_ == 0;
  skipped_ = (skipped_ + 1) % every_;
  if (!open_) return;
  time_ = time;
  state_ = plant.state();
}

void Recorder::finish_row(const drive_signals_t& signals, const drive_samples_t& samples) {
  if (!open_) return;
  open_ = false;
  const Information told = information_(state_, samples);
  const Row row{time_, state_, signals, told};
  std::size_t k = 0;
  for (const Column& c : kColumns) {
    if (is_here(c)) values_[k++].push_back(c.value(row));
  }
}

std::vector<std::vector<double>> Recorder::take(double origin) {
  for (double& time : values_.front()) time -= origin;
  return std::move(values_);
}

}  // namespace stillspin::bench
