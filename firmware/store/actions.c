#include "firmware/store/actions.h"

#include "firmware/api/status.h"
#include "firmware/mode/commands.h"
#include "firmware/store/store.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/packed_text.h"

// Why the store did not begin.
static answer_status_t refuse_store(bool needs_rest, octet_writer_t* why) {
  if (feature_status.stepped) {
    put_packed(why, SAY_not_in_the_loop_parameters_are_the_simulations);
    return ANSWER_STATE;
  }
  if (needs_rest && drive_is_energised()) {
    put_packed(why, SAY_not_while_the_power_stage_is_on);
    return ANSWER_RUNNING;
  }
  put_packed(why, SAY_the_store_is_busy);
  put_message(why, CATALOGUE_STORE, (uint16_t)store_state());
  return ANSWER_BUSY;
}

answer_status_t action_save(octet_writer_t* why) {
  return !feature_status.stepped && store_save() ? ANSWER_OK : refuse_store(false, why);
}

answer_status_t action_load(octet_writer_t* why) {
  return !feature_status.stepped && store_load() ? ANSWER_OK : refuse_store(true, why);
}

answer_status_t action_defaults(octet_writer_t* why) {
  return !feature_status.stepped && store_defaults() ? ANSWER_OK : refuse_store(true, why);
}
