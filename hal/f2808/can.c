// Mailboxes: receive groups from 31 down, each with its open (overwritable) mailbox at its lower end; the rest, from 0
// up, transmits. Control registers see 32-bit accesses alone, and the handshake of configuration is polled from
// hal_can_service, one look a call. Source: SPRUEU1 (eCAN); SPRZ171 (transmission stops; 16-bit accesses).

#include "hal/f2808/f2808_values.h"
#include "hal/f2808/gpio.h"
#include "hal/f2808/reg_access.h"
#include "hal/f2808/registers.h"
#include "hal/hal_board.h"
#include "hal/hal_can.h"
#include "hal/hal_time.h"
#include "hal/qmath/qdiv.h"

#define QUANTA_MAX 20u
#define QUANTA_MIN 10u  // of the rates that 100 MHz can be divided to exactly, none needs fewer
#define PRESCALER_MAX 256u
#define MASTER_BASE (CANMC_SCB_MASK | CANMC_SUSP_MASK)  // 32 mailboxes, ABO off: the application decides
#define TPL_STEP 8u
#define ALL_MAILBOXES 0xFFFFFFFFuL
#define ERROR_FLAGS (CANES_ACKE_MASK | CANES_SE_MASK | CANES_CRCE_MASK | CANES_SA1_MASK | CANES_BE_MASK | CANES_FE_MASK)

// A mailbox that is not emptied for so long, on a bus without errors, is the erratum's; or the bus is full of frames
// with smaller identifiers, and then the restart does no harm.
#define STALL_CYCLES (HAL_TIME_CYCLES_PER_US * 100000uL)
#define REREADS 3u

typedef enum { PHASE_OFF, PHASE_ENTER, PHASE_LEAVE, PHASE_RUN } phase_t;

static struct {
  phase_t phase;
  bool configured;  // mailboxes and bit timing are in the controller
  bool bus_off;
  uint16_t group_count;
  uint16_t lost, bus_offs, restarts;
  uint32_t timing;  // CANBTC
  uint32_t transmit_mailboxes;
  uint32_t protected_mailboxes;          // that are not overwritten
  uint32_t waiting[HAL_CAN_PRIORITIES];  // mailboxes handed over and not known to be empty
  uint32_t last_progress;                // cycles
  hal_can_group_t groups[HAL_CAN_GROUPS_MAX];
  uint32_t group_mailboxes[HAL_CAN_GROUPS_MAX];
} can;

static uint32_t bit_of(uint16_t mailbox) { return 1uL << mailbox; }

static void count(uint16_t* counter) { *counter = (uint16_t)(*counter + (*counter < 0xFFFFu ? 1u : 0u)); }

// As many quanta as possible, sampled at 75 to 80 %.
static bool find_timing(uint32_t bitrate, uint32_t* timing) {
  if (bitrate < 10000uL || bitrate > 1000000uL) return false;
  for (uint32_t quanta = QUANTA_MAX; quanta >= QUANTA_MIN; quanta--) {
    const uint32_t prescaler = HAL_TIME_CYCLES_PER_S / (bitrate * quanta);
    const bool exact = prescaler * bitrate * quanta == HAL_TIME_CYCLES_PER_S;
    if (!exact || prescaler > PRESCALER_MAX) continue;
    const uint32_t after = quanta / 5u;  // 2 to 4, and as many to resynchronise by
    const uint32_t before = quanta - 1u - after;
    *timing = (prescaler - 1u) << CANBTC_BRPREG_LSB | (after - 1u) << CANBTC_SJWREG_LSB |
              (before - 1u) << CANBTC_TSEG1REG_LSB | (after - 1u) << CANBTC_TSEG2REG_LSB;
    return true;
  }
  return false;
}

// A group's lowest mailbox stays open, so that a frame too many is told (RML) instead of lost without a word.
static bool share_mailboxes(const hal_can_group_t* groups, uint16_t group_count) {
  uint16_t left = HAL_CAN_MAILBOXES;
  if (group_count > HAL_CAN_GROUPS_MAX) return false;
  can.transmit_mailboxes = ALL_MAILBOXES;
  can.protected_mailboxes = 0uL;
  for (uint16_t g = 0u; g < group_count; g++) {
    if (groups[g].mailboxes == 0u || groups[g].mailboxes >= left) return false;
    left = (uint16_t)(left - groups[g].mailboxes);
    can.groups[g] = groups[g];
    const uint32_t lowest = bit_of(left);
    can.group_mailboxes[g] = can.transmit_mailboxes & ~(lowest - 1u);
    can.protected_mailboxes |= can.group_mailboxes[g] & ~lowest;
    can.transmit_mailboxes = lowest - 1u;
  }
  can.group_count = group_count;
  return true;
}

static void write_protected(uint32_t address, uint32_t value) {
  target_eallow();
  target_write32(address, value);
  target_edis();
}

static bool in_configuration(void) { return (target_read32(REG_CANES) & CANES_CCE_MASK) != 0uL; }

static void forget_waiting(void) {
  for (uint16_t p = 0u; p < HAL_CAN_PRIORITIES; p++) can.waiting[p] = 0uL;
}

static void request_configuration(void) {
  write_protected(REG_CANMC, MASTER_BASE | CANMC_CCR_MASK);
  can.phase = PHASE_ENTER;
}

bool hal_can_init(uint32_t bitrate, const hal_can_group_t* groups, uint16_t group_count) {
  if (!find_timing(bitrate, &can.timing) || !share_mailboxes(groups, group_count)) {
    hal_can_off();
    return false;
  }
  can.configured = false;
  can.bus_off = false;
  can.lost = can.bus_offs = can.restarts = 0u;
  forget_waiting();
  gpio_connect(BOARD_PIN_CAN_RECEIVE);
  gpio_connect(BOARD_PIN_CAN_TRANSMIT);
  write_protected(REG_CANTIOC, CANTIOC_TXFUNC_MASK);
  write_protected(REG_CANRIOC, CANRIOC_RXFUNC_MASK);
  request_configuration();
  return true;
}

void hal_can_off(void) {
  can.phase = PHASE_OFF;
  can.configured = can.bus_off = false;
  forget_waiting();
  write_protected(REG_CANMC, MASTER_BASE | CANMC_CCR_MASK);
  target_write32(REG_CANTRR, ALL_MAILBOXES);
  target_write32(REG_CANME, 0uL);
}

static uint32_t id_field(uint32_t id, bool extended) {
  return extended ? id & CANMSGID_EXTENDED_MASK : (id << CANMSGID_STANDARD_LSB) & CANMSGID_STANDARD_MASK;
}

static void configure_group(uint16_t g) {
  const hal_can_group_t* group = &can.groups[g];
  const uint32_t format = group->extended ? CANMSGID_IDE_MASK : 0uL;
  for (uint16_t n = 0u; n < HAL_CAN_MAILBOXES; n++) {
    if ((can.group_mailboxes[g] & bit_of(n)) == 0uL) continue;
    target_write32(REG_CANMSGID(n), format | CANMSGID_AME_MASK | id_field(group->id, group->extended));
    target_write32(REG_CANLAM(n), ~id_field(group->mask, group->extended) & CANMSGID_EXTENDED_MASK);
  }
}

static void configure(void) {
  write_protected(REG_CANBTC, can.timing);
  target_write32(REG_CANME, 0uL);
  target_write32(REG_CANTRR, ALL_MAILBOXES);
  for (uint16_t n = 0u; n < HAL_CAN_MAILBOXES; n++) target_write32(REG_CANMSGCTRL(n), 0uL);
  for (uint16_t g = 0u; g < can.group_count; g++) configure_group(g);
  target_write32(REG_CANMD, ~can.transmit_mailboxes);
  target_write32(REG_CANOPC, can.protected_mailboxes);
  target_write32(REG_CANTA, ALL_MAILBOXES);
  target_write32(REG_CANAA, ALL_MAILBOXES);
  target_write32(REG_CANRMP, ALL_MAILBOXES);
  target_write32(REG_CANES, ERROR_FLAGS);
  target_write32(REG_CANME, ~can.transmit_mailboxes);
  can.configured = true;
}

// What has left its mailbox since the last look.
static uint32_t reap(void) {
  const uint32_t requested = target_read32(REG_CANTRS);
  uint32_t waiting = 0uL;
  for (uint16_t p = 0u; p < HAL_CAN_PRIORITIES; p++) {
    if ((can.waiting[p] & ~requested) != 0uL) can.last_progress = hal_time_cycles();
    can.waiting[p] &= requested;
    waiting |= can.waiting[p];
  }
  if (waiting == 0uL) can.last_progress = hal_time_cycles();
  return requested;
}

static void watch_mailboxes(uint32_t status) {
  (void)reap();
  if ((status & (CANES_EW_MASK | CANES_EP_MASK)) != 0uL) can.last_progress = hal_time_cycles();
  if (hal_time_cycles() - can.last_progress < STALL_CYCLES) return;
  count(&can.restarts);
  request_configuration();
}

static void watch_bus(void) {
  const uint32_t status = target_read32(REG_CANES);
  const bool off = (status & CANES_BO_MASK) != 0uL;
  if (off && !can.bus_off) {
    count(&can.bus_offs);
    target_write32(REG_CANTRR, can.transmit_mailboxes);
    forget_waiting();
  }
  can.bus_off = off;
  if (!off) watch_mailboxes(status);
}

void hal_can_service(void) {
  switch (can.phase) {
    case PHASE_ENTER:
      if (!in_configuration()) break;
      if (!can.configured) configure();
      write_protected(REG_CANMC, MASTER_BASE);
      can.phase = PHASE_LEAVE;
      break;
    case PHASE_LEAVE:
      if (in_configuration()) break;
      can.last_progress = hal_time_cycles();
      can.phase = PHASE_RUN;
      break;
    case PHASE_RUN:
      watch_bus();
      break;
    default:
      break;
  }
}

// ---- frames ------------------------------------------------------------------------------------------------

// The pending mailbox whose frame came first: time stamps count bits, so no two are equal.
static bool oldest(uint32_t pending, uint16_t* mailbox) {
  uint32_t best = 0uL;
  bool found = false;
  while (pending != 0uL) {
    const uint16_t n = (uint16_t)(31u - q_clz32(pending));
    const uint32_t stamp = target_read32(REG_CANMOTS(n));
    if (!found || (int32_t)(stamp - best) < 0) {
      best = stamp;
      *mailbox = n;
      found = true;
    }
    pending &= ~bit_of(n);
  }
  return found;
}

static void unpack(uint32_t word, uint16_t* octets) {
  for (uint16_t i = 0u; i < 4u; i++) octets[i] = (uint16_t)(word >> (24u - 8u * i) & 0xFFuL);
}

static uint32_t pack(const uint16_t* octets) {
  uint32_t word = 0uL;
  for (uint16_t i = 0u; i < 4u; i++) word = word << 8 | (octets[i] & 0xFFu);
  return word;
}

// What a mailbox holds; false for a remote request.
static bool read_content(uint16_t n, hal_can_frame_t* frame) {
  const uint32_t id = target_read32(REG_CANMSGID(n));
  const uint32_t control = target_read32(REG_CANMSGCTRL(n));
  const uint16_t length = (uint16_t)(control & CANMSGCTRL_DLC_MASK);
  unpack(target_read32(REG_CANMDL(n)), &frame->data[0]);
  unpack(target_read32(REG_CANMDH(n)), &frame->data[4]);
  frame->extended = (id & CANMSGID_IDE_MASK) != 0uL;
  frame->id = frame->extended ? id & CANMSGID_EXTENDED_MASK : (id & CANMSGID_STANDARD_MASK) >> CANMSGID_STANDARD_LSB;
  frame->length = length > 8u ? 8u : length;
  return (control & CANMSGCTRL_RTR_MASK) == 0uL;
}

// A protected mailbox keeps its frame until its flag is cleared, and takes the next one from then on: the flag is
// cleared behind the reading. The open one may be overwritten while it is read: its flag, cleared before, is then set
// again.
static bool read_mailbox(uint16_t n, hal_can_frame_t* frame) {
  bool is_data = false;
  if ((can.protected_mailboxes & bit_of(n)) != 0uL) {
    is_data = read_content(n, frame);
    target_write32(REG_CANRMP, bit_of(n));
    return is_data;
  }
  for (uint16_t reads = 0u; reads < REREADS; reads++) {
    if ((target_read32(REG_CANRML) & bit_of(n)) != 0uL) count(&can.lost);
    target_write32(REG_CANRMP, bit_of(n));
    is_data = read_content(n, frame);
    if ((target_read32(REG_CANRMP) & bit_of(n)) == 0uL) break;
    count(&can.lost);
  }
  return is_data;
}

bool hal_can_receive(uint16_t group, hal_can_frame_t* frame) {
  if (!can.configured || group >= can.group_count) return false;
  uint32_t pending = target_read32(REG_CANRMP) & can.group_mailboxes[group];
  uint16_t mailbox = 0u;
  while (oldest(pending, &mailbox)) {
    if (read_mailbox(mailbox, frame)) return true;
    pending &= ~bit_of(mailbox);
  }
  return false;
}

// Of equal TPL the higher mailbox goes first: a frame goes below all that wait with its priority.
static bool find_mailbox(uint16_t priority, uint32_t requested, uint16_t* mailbox) {
  uint32_t candidates = can.transmit_mailboxes & ~requested;
  const uint32_t ahead = can.waiting[priority];
  if (ahead != 0uL) candidates &= (ahead & (~ahead + 1u)) - 1u;
  if (candidates == 0uL) return false;
  *mailbox = (uint16_t)(31u - q_clz32(candidates));
  return true;
}

bool hal_can_send(const hal_can_frame_t* frame, uint16_t priority) {
  uint16_t n = 0u;
  if (can.phase != PHASE_RUN || can.bus_off || priority >= HAL_CAN_PRIORITIES || frame->length > 8u) return false;
  if (!find_mailbox(priority, reap(), &n)) return false;
  const uint32_t format = frame->extended ? CANMSGID_IDE_MASK : 0uL;
  // The identifier can be written only while the mailbox is disabled.
  target_write32(REG_CANME, target_read32(REG_CANME) & ~bit_of(n));
  target_write32(REG_CANMSGID(n), format | id_field(frame->id, frame->extended));
  target_write32(REG_CANMSGCTRL(n), (uint32_t)frame->length | (uint32_t)(priority * TPL_STEP) << CANMSGCTRL_TPL_LSB);
  target_write32(REG_CANMDL(n), pack(&frame->data[0]));
  target_write32(REG_CANMDH(n), pack(&frame->data[4]));
  target_write32(REG_CANME, target_read32(REG_CANME) | bit_of(n));
  target_write32(REG_CANTA, bit_of(n));
  target_write32(REG_CANTRS, bit_of(n));
  can.waiting[priority] |= bit_of(n);
  return true;
}

void hal_can_cancel(uint16_t priority) {
  if (priority < HAL_CAN_PRIORITIES) target_write32(REG_CANTRR, can.waiting[priority]);
}

uint16_t hal_can_waiting(uint16_t priority) {
  uint16_t number = 0u;
  if (priority >= HAL_CAN_PRIORITIES) return 0u;
  (void)reap();
  for (uint32_t left = can.waiting[priority]; left != 0uL; left &= left - 1u) number++;
  return number;
}

// ---- state -------------------------------------------------------------------------------------------------

static hal_can_state_t bus_state(uint32_t status) {
  if (can.phase == PHASE_OFF) return HAL_CAN_OFF;
  if ((status & CANES_BO_MASK) != 0uL) return HAL_CAN_BUS_OFF;
  if (can.phase != PHASE_RUN) return HAL_CAN_STARTING;
  if ((status & CANES_EP_MASK) != 0uL) return HAL_CAN_PASSIVE;
  return (status & CANES_EW_MASK) != 0uL ? HAL_CAN_WARNING : HAL_CAN_ACTIVE;
}

hal_can_status_t hal_can_status(void) {
  hal_can_status_t status;
  status.state = bus_state(target_read32(REG_CANES));
  status.transmit_errors = (uint16_t)(target_read32(REG_CANTEC) & CAN_COUNTER_MASK);
  status.receive_errors = (uint16_t)(target_read32(REG_CANREC) & CAN_COUNTER_MASK);
  status.lost = can.lost;
  status.bus_offs = can.bus_offs;
  status.restarts = can.restarts;
  return status;
}

void hal_can_recover(void) {
  if (can.phase == PHASE_RUN && can.bus_off) write_protected(REG_CANMC, MASTER_BASE);
}
