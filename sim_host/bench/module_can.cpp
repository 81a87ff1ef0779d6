// The messages of the firmware's CAN node in the Python module: what the table says, and its packing and unpacking.

#include <nanobind/nanobind.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>

#include "firmware/can/messages.h"
#include "sim_host/bench/module_setup.hpp"

namespace nb = nanobind;

namespace stillspin::bench {
namespace {

// What the drive itself does not need of the table.
struct Message {
  const char *name, *sender, *meaning;
};
struct Field {
  const char *name, *unit, *meaning;
};

#define CAN_MESSAGE(message, base, octets, sender, meaning) {#message, #sender, meaning},
#define CAN_FIELD(message, field, first, bits, sign, per_unit, unit, meaning)
constexpr Message kMessages[] = {
#include "firmware/can/message_list.h"
};
#undef CAN_MESSAGE
#undef CAN_FIELD

#define CAN_MESSAGE(message, base, octets, sender, meaning)
#define CAN_FIELD(message, field, first, bits, sign, per_unit, unit, meaning) {#field, unit, meaning},
constexpr Field kFields[] = {
#include "firmware/can/message_list.h"
};
#undef CAN_MESSAGE
#undef CAN_FIELD

can_message_t message_named(const std::string& name) {
  for (std::uint16_t k = 0; k < CAN_MESSAGES; k++) {
    if (name == kMessages[k].name) return static_cast<can_message_t>(k);
  }
  throw std::invalid_argument("there is no CAN message " + name);
}

nb::list fields_of(can_message_t message) {
  nb::list fields;
  for (std::uint16_t k = 0; k < CAN_FIELDS; k++) {
    const can_field_info_t& f = *can_field_info(k);
    if (f.message != message) continue;
    nb::dict field;
    field["name"] = kFields[k].name;
    field["first"] = unsigned{f.first};
    field["bits"] = unsigned{f.bits};
    field["signed"] = f.is_signed != 0;
    field["per_unit"] = unsigned{f.per_unit};
    field["unit"] = kFields[k].unit;
    field["meaning"] = kFields[k].meaning;
    fields.append(field);
  }
  return fields;
}

nb::list messages() {
  nb::list all;
  for (std::uint16_t k = 0; k < CAN_MESSAGES; k++) {
    const can_message_info_t& m = *can_message_info(k);
    nb::dict message;
    message["name"] = kMessages[k].name;
    message["base"] = unsigned{m.base};
    message["octets"] = unsigned{m.octets};
    message["sender"] = kMessages[k].sender;
    message["meaning"] = kMessages[k].meaning;
    message["fields"] = fields_of(static_cast<can_message_t>(k));
    all.append(message);
  }
  return all;
}

hal_can_frame_t frame_with(std::uint32_t id, const nb::bytes& data) {
  if (data.size() > 8) throw std::invalid_argument("a CAN frame has up to 8 octets");
  hal_can_frame_t frame = {id, false, static_cast<std::uint16_t>(data.size()), {}};
  const auto* const octets = static_cast<const std::uint8_t*>(data.data());
  for (std::size_t n = 0; n < data.size(); n++) frame.data[n] = octets[n];
  return frame;
}

nb::tuple encode(const std::string& name, std::uint16_t node, const std::map<std::string, std::int64_t>& steps) {
  const can_message_t message = message_named(name);
  hal_can_frame_t frame = can_frame(message, node);
  for (std::uint16_t k = 0; k < CAN_FIELDS; k++) {
    const auto given = steps.find(kFields[k].name);
    if (can_field_info(k)->message != message || given == steps.end()) continue;
    can_put(&frame, static_cast<can_field_t>(k), static_cast<std::int32_t>(given->second));
  }
  std::string octets;
  for (unsigned n = 0; n < frame.length; n++) octets.push_back(static_cast<char>(frame.data[n]));
  return nb::make_tuple(frame.id, nb::bytes(octets.data(), octets.size()));
}

nb::dict decode(const std::string& name, const nb::bytes& data) {
  const can_message_t message = message_named(name);
  const hal_can_frame_t frame = frame_with(0, data);
  nb::dict steps;
  for (std::uint16_t k = 0; k < CAN_FIELDS; k++) {
    const can_field_info_t& f = *can_field_info(k);
    if (f.message == message) steps[kFields[k].name] = can_get(&frame, static_cast<can_field_t>(k));
  }
  return steps;
}

unsigned crc8(std::uint32_t id, const nb::bytes& data) {
  const hal_can_frame_t frame = frame_with(id, data);
  return can_crc8(&frame, frame.length);
}

}  // namespace

void bind_can_messages(nb::module_& m) {
  m.def("can_messages", &messages, "The table of the bus' messages.");
  m.def("can_encode", &encode, nb::arg("message"), nb::arg("node"), nb::arg("steps"),
        "Identifier and data as the firmware packs fields, given in steps.");
  m.def("can_decode", &decode, nb::arg("message"), nb::arg("data"), "Fields as the firmware unpacks them.");
  m.def("can_crc8", &crc8, nb::arg("id"), nb::arg("data"), "Check sum of a command.");
}

}  // namespace stillspin::bench
