// What the tests of the parameter store have in common: power-on, save, and a look at the memory.

#ifndef STILLSPIN_TESTS_FIRMWARE_STORE_HPP
#define STILLSPIN_TESTS_FIRMWARE_STORE_HPP

#include <map>

#include "tests/firmware/fake_hal.hpp"
#include "tests/firmware/fake_nvm.hpp"
#include "tests/firmware/slot_of.hpp"

extern "C" {
#include "firmware/dictionary/parameters.h"
#include "firmware/drive/reset.h"
#include "firmware/mode/commands.h"
#include "firmware/store/store.h"
#include "firmware/store/values.h"
}

namespace stillspin::test {

class Store : public Drive {
 protected:
  using Values = std::map<std::uint16_t, std::int32_t>;

  void SetUp() override {
    NEEDS("store");
    Drive::SetUp();
    nvm = FakeNvm{};
  }

  /// Until it has nothing to do; how many steps that took.
  static int serve() {
    int steps = 0;
    while (store_is_busy()) {
      store_service();
      if (++steps > 100000) {
        ADD_FAILURE() << "the store does not come to an end";
        break;
      }
    }
    return steps;
  }

  /// The power comes back, the firmware starts.
  static store_state_t power_on() {
    nvm.powered = true;
    nvm.cut_at_octet = nvm.cut_at_page = -1;
    nvm.state = NVM_IDLE;
    drive_reset();
    store_begin();
    serve();
    return store_state();
  }

  static store_state_t save() {
    EXPECT_TRUE(store_save());
    serve();
    return store_state();
  }

  static Values in_force() {
    Values values;
    for (std::uint16_t k = 0; k < parameter_count(); ++k) {
      const std::uint16_t id = parameter_info(k)->id;
      values[id] = parameter_get(id);
    }
    return values;
  }
  static Values defaults() {
    Values values;
    for (std::uint16_t k = 0; k < parameter_count(); ++k)
      values[parameter_info(k)->id] = parameter_initial(parameter_info(k));
    return values;
  }
  /// Sets of values that differ in every parameter whose range is wider, and fit together.
  static void set_variant(int n) {
    parameters.drop_band += n;
    parameters.pulse_time += n;
    parameters.stop_time = 1000 + n;
    parameters.speed_ramp += n;
    parameters.ldq_1 = -n;
  }

  // ---- a memory as another firmware would have left it
  struct Image {
    std::uint16_t version = SLOT_VERSION;
    std::uint32_t sequence = 1;
    std::vector<slot_entry_t> entries;
  };
  static std::vector<slot_entry_t> table() {
    std::vector<slot_entry_t> entries;
    for (std::uint16_t k = 0; k < parameter_count(); ++k) {
      const parameter_info_t* const info = parameter_info(k);
      entries.push_back({info->id, info->q, parameter_initial(info)});
    }
    return entries;
  }
  static slot_entry_t& entry(Image& image, std::uint16_t id) {
    return *std::find_if(image.entries.begin(), image.entries.end(), [=](const slot_entry_t& e) { return e.id == id; });
  }
  static void put(unsigned slot, const Image& image) {
    const std::vector<std::uint16_t> octets = slot_of(image.version, image.sequence, image.entries);
    std::copy(octets.begin(), octets.end(), nvm.memory.begin() + slot * SLOT_SIZE);
  }
  static std::vector<slot_entry_t> entries_of(unsigned slot) {
    std::vector<std::uint16_t> octets(nvm.memory.begin() + slot * SLOT_SIZE,
                                      nvm.memory.begin() + (slot + 1) * SLOT_SIZE);
    slot_header_t header;
    slot_unpack_header(octets.data(), &header);
    std::vector<slot_entry_t> entries;
    for (unsigned k = 0; k < header.count && k < SLOT_ENTRIES_MAX; ++k) {
      slot_entry_t entry;
      slot_unpack_entry(octets.data() + SLOT_HEADER + k * SLOT_ENTRY, &entry);
      entries.push_back(entry);
    }
    return entries;
  }
};

}  // namespace stillspin::test

#endif
