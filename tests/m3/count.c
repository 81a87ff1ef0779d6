// A plugin of QEMU: counts the instructions of the drive's interrupts, by step and by function, in a replay (replay.c).
//
// Options: regions=FILE, a line `START END WEIGHT` (addresses in hexadecimal, hundredths of a cycle for an instruction)
// for every function, and `mark NAME ADDRESS`; entry=N, cycles of entering and leaving an interrupt; out=FILE.
// That file gets a line `cost PHASE STEP COUNT INSTRUCTIONS WORST CYCLES WORST` for every step (sums and worst
// periods), and a line `function PHASE REGION INSTRUCTIONS WORST` for every function: of all periods, and of the
// longest one.
//
// A period begins with the control interrupt and ends where the next one does; windows' interrupts in it are part of
// it. A function of the drive is counted wherever an interrupt calls it; what is in no region is not.

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The part of QEMU's qemu-plugin.h that is used here, version 1; distributions do not bring that file.
typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
typedef struct qemu_info_t qemu_info_t;
enum qemu_plugin_cb_flags { QEMU_PLUGIN_CB_NO_REGS };
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb* tb);
uint64_t qemu_plugin_tb_vaddr(const struct qemu_plugin_tb* tb);
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id, void (*cb)(qemu_plugin_id_t, struct qemu_plugin_tb*));
void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb* tb, void (*cb)(unsigned, void*),
                                          enum qemu_plugin_cb_flags flags, void* data);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*cb)(qemu_plugin_id_t, void*), void* data);

#define EXPORTED __attribute__((visibility("default")))
EXPORTED int qemu_plugin_version = 1;
EXPORTED int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t* info, int argc, char** argv);

#define REGIONS 4096
#define NESTED 8

enum { RESTING, STARTING, TURNING, COMMISSION, PHASES };
static const char* const phase_names[PHASES] = {"resting", "starting", "turning", "commissioning"};
// Of the control interrupt, those of its periods' windows together, each of those by itself, and the whole period.
enum { SAMPLES, ESTIMATE, SUPERVISE, CONTROL, MODULATE, HAND_OVER, LINK, WINDOWS, WINDOW, ALL, STEPS };
static const char* const step_names[STEPS] = {"samples",   "estimate", "supervise", "control", "modulate",
                                              "hand_over", "link",     "windows",   "window",  "all"};
// A period's mark is its phase. Steps begin with a function of the drive or of a driver; where a drive has no frame to
// hand over the link comes behind the modulation.
enum { OTHER = PHASES, RETURN, PAUSE, RESUME, BEGINS_ESTIMATE, BEGINS_LINK = BEGINS_ESTIMATE + 5, NO_MARK };
static const char* const mark_names[NO_MARK] = {
    "mark_resting",        "mark_starting",  "mark_turning",  "mark_commission", "mark_window",
    "mark_return",         "mark_pause",     "mark_resume",   "drive_estimate",  "drive_protect",
    "drive_control_speed", "drive_modulate", "hal_pwm_write", "hal_sci_service"};

typedef struct {
  uint64_t instructions, cycles;  // hundredths of a cycle
} cost_t;
typedef struct {
  uint64_t count;
  cost_t sum, worst;
} statistic_t;
typedef struct {
  uint64_t start, end;
  uint32_t weight;
} region_t;
typedef struct {
  uint32_t region, count, mark;
} block_t;

static region_t regions[REGIONS];
static uint32_t region_count;
static uint64_t marks[NO_MARK];
static uint64_t entry;  // hundredths of a cycle
static FILE* out;

static struct {
  bool window, paused;
} nested[NESTED];
static uint32_t depth;  // 0: no interrupt
static uint32_t phase = PHASES, step;
static cost_t spent[STEPS];
static uint32_t ran[REGIONS];
static statistic_t statistics[PHASES][STEPS];
static uint64_t functions[PHASES][REGIONS];
static uint32_t longest[PHASES][REGIONS];

static void add(statistic_t* s, const cost_t* c) {
  s->count++;
  s->sum.instructions += c->instructions;
  s->sum.cycles += c->cycles;
  if (c->instructions > s->worst.instructions) s->worst.instructions = c->instructions;
  if (c->cycles > s->worst.cycles) s->worst.cycles = c->cycles;
}

static void enter(uint32_t of) {
  spent[of].cycles += entry;
  spent[ALL].cycles += entry;
}

static void end_period(void) {
  if (phase < PHASES) {
    statistic_t* const table = statistics[phase];
    const bool is_longest = spent[ALL].cycles > table[ALL].worst.cycles;
    for (uint32_t k = 0; k < STEPS; k++) {
      const bool is_part = k <= LINK ? k < step || k == LINK : k != WINDOW;
      if (is_part) add(&table[k], &spent[k]);
    }
    for (uint32_t k = 0; k < region_count; k++) functions[phase][k] += ran[k];
    if (is_longest) memcpy(longest[phase], ran, sizeof ran);
  }
  memset(spent, 0, sizeof spent);
  memset(ran, 0, sizeof ran);
  step = 0;
}

static void begin(uint32_t mark) {
  if (depth == NESTED) abort();
  nested[depth].window = mark == OTHER;
  nested[depth++].paused = false;
  if (mark == OTHER) {
    memset(&spent[WINDOW], 0, sizeof spent[WINDOW]);
    enter(WINDOWS);
    spent[WINDOW].cycles += entry;
  } else {
    end_period();
    phase = mark;
    enter(SAMPLES);
  }
}

static void end(void) {
  if (depth == 0u) abort();
  depth--;
  if (nested[depth].window && phase < PHASES) add(&statistics[phase][WINDOW], &spent[WINDOW]);
}

static void take_mark(uint32_t mark) {
  if (mark <= OTHER) begin(mark);
  if (mark == RETURN) end();
  if (depth == 0u) return;
  if (mark == PAUSE) nested[depth - 1u].paused = true;
  if (mark == RESUME) nested[depth - 1u].paused = false;
  if (nested[depth - 1u].window) return;
  if (mark >= BEGINS_ESTIMATE && step + 1u == ESTIMATE + (mark - BEGINS_ESTIMATE)) step++;
  if (mark == BEGINS_LINK && step == MODULATE) step = LINK;
}

static void charge(uint32_t to, const block_t* b) {
  spent[to].instructions += b->count;
  spent[to].cycles += (uint64_t)b->count * regions[b->region].weight;
}

static void run(unsigned cpu, void* data) {
  const block_t* const b = data;
  (void)cpu;
  if (b->mark != NO_MARK) take_mark(b->mark);
  if (b->region == REGIONS || depth == 0u || nested[depth - 1u].paused) return;
  if (nested[depth - 1u].window) {
    charge(WINDOW, b);
    charge(WINDOWS, b);
  } else {
    charge(step, b);
  }
  charge(ALL, b);
  ran[b->region] += b->count;
}

static uint32_t region_at(uint64_t address) {
  for (uint32_t k = 0; k < region_count; k++) {
    if (address >= regions[k].start && address < regions[k].end) return k;
  }
  return REGIONS;
}

static uint32_t mark_at(uint64_t address) {
  for (uint32_t k = 0; k < NO_MARK; k++) {
    if (address == marks[k]) return k;
  }
  return NO_MARK;
}

static void translated(qemu_plugin_id_t id, struct qemu_plugin_tb* tb) {
  const uint64_t address = qemu_plugin_tb_vaddr(tb);
  const block_t found = {region_at(address), (uint32_t)qemu_plugin_tb_n_insns(tb), mark_at(address)};
  (void)id;
  if (found.region == REGIONS && found.mark == NO_MARK) return;
  block_t* const b = malloc(sizeof *b);  // as long as QEMU runs
  if (b == NULL) abort();
  *b = found;
  qemu_plugin_register_vcpu_tb_exec_cb(tb, run, QEMU_PLUGIN_CB_NO_REGS, b);
}

static void report(qemu_plugin_id_t id, void* data) {
  (void)id;
  (void)data;
  for (uint32_t p = 0; p < PHASES; p++) {
    for (uint32_t k = 0; k < STEPS; k++) {
      const statistic_t* const s = &statistics[p][k];
      if (s->count == 0u) continue;
      fprintf(out, "cost %s %s %" PRIu64 " %" PRIu64 " %" PRIu64 " %.2f %.2f\n", phase_names[p], step_names[k],
              s->count, s->sum.instructions, s->worst.instructions, (double)s->sum.cycles / 100.0,
              (double)s->worst.cycles / 100.0);
    }
    for (uint32_t k = 0; k < region_count; k++) {
      if (functions[p][k] == 0u) continue;
      fprintf(out, "function %s %" PRIu32 " %" PRIu64 " %" PRIu32 "\n", phase_names[p], k, functions[p][k],
              longest[p][k]);
    }
  }
  fclose(out);
}

static bool read_regions(const char* path) {
  FILE* const in = fopen(path, "r");
  char line[128], name[32];
  if (in == NULL) return false;
  while (fgets(line, sizeof line, in) != NULL) {
    uint64_t address = 0;
    if (sscanf(line, "mark %31s %" SCNx64, name, &address) == 2) {
      for (uint32_t k = 0; k < NO_MARK; k++) marks[k] = strcmp(name, mark_names[k]) == 0 ? address : marks[k];
      continue;
    }
    region_t* const r = &regions[region_count];
    if (region_count == REGIONS - 1u ||
        sscanf(line, "%" SCNx64 " %" SCNx64 " %" SCNu32, &r->start, &r->end, &r->weight) != 3) {
      fclose(in);
      return false;
    }
    region_count++;
  }
  fclose(in);
  for (uint32_t k = 0; k < NO_MARK; k++) {
    if (marks[k] == 0u) return false;
  }
  return true;
}

int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t* info, int argc, char** argv) {
  (void)info;
  bool is_read = false;
  for (int k = 0; k < argc; k++) {
    if (strncmp(argv[k], "regions=", 8) == 0) is_read = read_regions(argv[k] + 8);
    if (strncmp(argv[k], "entry=", 6) == 0) entry = 100u * strtoull(argv[k] + 6, NULL, 10);
    if (strncmp(argv[k], "out=", 4) == 0) out = fopen(argv[k] + 4, "w");
  }
  if (!is_read || out == NULL) {
    fprintf(stderr, "count: regions or marks are missing, or the file to write\n");
    return 1;
  }
  qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
  qemu_plugin_register_atexit_cb(id, report, NULL);
  return 0;
}
