// What the pieces of serial port, bus and console need and give, in ACSL: each is read by itself with anything that its
// header admits, and what calls it is read with these lines in its place.

#ifndef STILLSPIN_TESTS_PROVE_LINK_RANGES_H
#define STILLSPIN_TESTS_PROVE_LINK_RANGES_H

#include "firmware/can/segments.h"
#include "firmware/console/commands.h"
#include "firmware/console/suggest/suggest.h"
#include "firmware/dictionary/units.h"
#include "firmware/link/splitter.h"
#include "firmware/text/catalogue.h"
#include "firmware/text/text.h"
#include "tests/prove/qmath_ranges.h"

/*@ requires count == 0 || \valid_read(octets + (0 .. count - 1)); assigns \result \from octets[0 .. count - 1]; */
uint16_t crc16(const uint16_t* octets, uint16_t count);

/*@ requires count <= 245 && \valid_read(from + (0 .. 244)) && \valid(to + (0 .. 245));
    assigns to[0 .. 245] \from from[0 .. 244]; assigns \result \from count;
    ensures \result <= 246; ensures \initialized(to + (0 .. 245)); */
uint16_t cobs_encode(const uint16_t* from, uint16_t count, uint16_t* to);

/*@ requires count <= 256 && \valid(octets + (0 .. 255));
    assigns octets[0 .. 255], \result \from octets[0 .. 255], count; */
uint16_t cobs_decode(uint16_t* octets, uint16_t count);

/*@ requires \valid(s); assigns *s, \result \from *s, octet, now_ms;
    ensures -1 <= \result <= 257; ensures \result == -1 ==> s->count <= 243;
    ensures s->count <= 257; ensures s->in_record && !s->skipping ==> s->count <= 256; */
int16_t splitter_octet(splitter_t* s, uint16_t octet, uint32_t now_ms);

/*@ requires \valid(s); assigns *s, \result \from *s, now_ms; ensures 0 <= \result <= 257;
    ensures s->count <= 257; ensures s->in_record && !s->skipping ==> s->count <= 256; */
int16_t splitter_rest(splitter_t* s, uint32_t now_ms);

/*@ requires \valid(j) && \valid_read(frame); assigns *j, \result \from *j, *frame, now_ms;
    ensures \result == 0 || \result == 1; ensures j->open == 0 || j->open == 1; ensures j->count <= 245; ensures \result
   == 1 ==> j->count <= 243; */
bool segment_join(segment_joiner_t* j, const hal_can_frame_t* frame, uint32_t now_ms);

/*@ requires text < PACKED_TEXTS; assigns \result \from text; */
packed_reader_t packed_reader(packed_text_t text);

/*@ requires \valid(r); assigns *r, \result \from *r; */
uint16_t packed_next(packed_reader_t* r);

/*@ requires \valid_read(from) && (count == 0 || \valid_read(wanted + (0 .. count - 1)));
    assigns \result \from *from, wanted[0 .. 79], count; ensures \result == 0 || \result == 1; */
bool packed_rest_is(const packed_reader_t* from, const uint16_t* wanted, uint16_t count);

/*@ requires \valid(w) && text < PACKED_TEXTS;
    assigns w->octets[0 .. w->room - 1], w->count, w->full \from w->count, w->room, text;
    ensures w->count <= w->room; ensures w->full == 0 || w->full == 1; */
void put_packed(octet_writer_t* w, packed_text_t text);

/*@ requires wanted == \null || \valid_read(wanted + (0 .. count - 1));
    requires text < PACKED_TEXTS && (wanted != \null || count == 0);
    assigns \result \from text, wanted[0 .. 79], count; ensures \result == 0 || \result == 1; */
bool packed_occurs(packed_text_t text, const uint16_t* wanted, uint16_t count);

/*@ requires text < PACKED_TEXTS; assigns \result \from text; ensures \result == 0 || \result == 1; */
bool packed_is_empty(packed_text_t text);

/*@ requires text < PACKED_TEXTS && (count == 0 || \valid_read(wanted + (0 .. count - 1)));
    assigns \result \from text, wanted[0 .. 79], count; ensures \result == 0 || \result == 1; */
bool packed_equals(packed_text_t text, const uint16_t* wanted, uint16_t count);

/*@ requires count == 0 || \valid_read(wanted + (0 .. count - 1));
    assigns \result \from first, texts, wanted[0 .. 79], count; ensures \result <= texts; */
uint16_t packed_find(packed_text_t first, uint16_t texts, const uint16_t* wanted, uint16_t count);

/*@ requires \valid(w) && \valid_read(text);
    assigns w->octets[0 .. w->room - 1], w->count, w->full \from w->count, w->room, text[0];
    ensures w->count <= w->room; ensures w->full == 0 || w->full == 1; */
void put_text(octet_writer_t* w, const char* text);

/*@ requires \valid(w); assigns w->octets[0 .. w->room - 1], w->count, w->full \from w->count, w->room, kind, code;
    ensures w->count <= w->room; ensures w->full == 0 || w->full == 1; */
void put_message(octet_writer_t* w, catalogue_t kind, uint16_t code);

/*@ requires \valid(w); assigns w->octets[0 .. w->room - 1], w->count, w->full \from w->count, w->room, value;
    ensures w->count <= w->room; ensures w->full == 0 || w->full == 1; */
void put_unsigned(octet_writer_t* w, uint32_t value);

/*@ requires \valid(w) && q <= 40 && decimals <= 9;
    assigns w->octets[0 .. w->room - 1], w->count, w->full \from w->count, w->room, raw, q, decimals;
    ensures w->count <= w->room; ensures w->full == 0 || w->full == 1; */
void put_fixed(octet_writer_t* w, int32_t raw, uint16_t q, uint16_t decimals);

/*@ requires \valid(w); assigns w->octets[0 .. w->room - 1], w->count, w->full \from w->count, w->room, column;
    ensures w->count <= w->room; ensures w->full == 0 || w->full == 1; */
void put_spaces_to(octet_writer_t* w, uint16_t column);

/*@ requires \valid(number) && count <= 80 && (count == 0 || \valid_read(text + (0 .. count - 1)));
    assigns *number, \result \from text[0 .. 79], count;
    ensures \initialized(&number->digits) && \initialized(&number->decimals);
    ensures \result <= count; ensures \result <= 80;
    ensures number->decimals <= 9; ensures -2147483647 <= number->digits; */
uint16_t text_number(const uint16_t* text, uint16_t count, decimal_t* number);

/*@ requires unit < UNITS; assigns \result \from unit; ensures -28 <= \result <= 28; */
int16_t unit_exponent(uint16_t unit);

/*@ requires \valid_read(number) && number->decimals <= 9 && q <= 40 && \valid(raw);
    assigns *raw, \result \from *number, q; ensures \initialized(raw);
    ensures \result == 0 || \result == 1; */
bool decimal_raw(const decimal_t* number, uint16_t q, int32_t* raw);

/*@ requires \valid_read(number) && number->decimals <= 9;
    assigns \result \from *number; ensures \result == 0 || \result == 1; */
bool decimal_is_whole(const decimal_t* number);

/*@ requires name < PACKED_TEXTS && \valid_read(word) && word->count <= 80;
    assigns \result \from name, word->count; ensures \result == 0 || \result == 1; */
bool suggest_is_near(packed_text_t name, const word_t* word);

/*@ requires \valid(e) && \valid(echo) && e->line.count <= 80;
    assigns *e, \result \from *e, octet;
    assigns echo->octets[0 .. echo->room - 1], echo->count, echo->full \from *e, octet, echo->count, echo->room;
    ensures echo->count <= echo->room; ensures echo->full == 0 || echo->full == 1;
    ensures e->too_long == 0 || e->too_long == 1; ensures e->disturbed == 0 || e->disturbed == 1;
    ensures e->expired == 0 || e->expired == 1; ensures e->cut == 0 || e->cut == 1;
    ensures e->line.count <= 80; ensures e->recalled <= 4;
    ensures e->history[0].count <= 80 && e->history[1].count <= 80 && e->history[2].count <= 80;
    ensures e->history[3].count <= 80; ensures 0 <= \result <= 2; */
editor_event_t editor_octet(editor_t* e, uint16_t octet, octet_writer_t* echo);

/*@ requires \valid(e) && e->line.count <= 80; assigns *e \from *e;
    ensures e->line.count == 0 && e->cursor == 0 && e->cut == 0;
    ensures e->history[0].count <= 80 && e->history[1].count <= 80 && e->history[2].count <= 80;
    ensures e->history[3].count <= 80; */
void editor_next(editor_t* e);

/*@ requires \valid_read(e) && \valid(echo) && e->line.count <= 80;
    assigns echo->octets[0 .. echo->room - 1], echo->count, echo->full \from *e, echo->count, echo->room;
    ensures echo->count <= echo->room; ensures echo->full == 0 || echo->full == 1; */
void editor_show(const editor_t* e, octet_writer_t* echo);

/*@ requires count <= 243 && \valid(record + (0 .. 244)) && \valid(wire + (0 .. 257));
    assigns record[0 .. 244], wire[0 .. 257], \result \from record[0 .. 244], count;
    ensures \initialized(record + (0 .. 244)) && \initialized(wire + (0 .. 257)); ensures \result <= 258; */
uint16_t record_to_wire(uint16_t* record, uint16_t count, uint16_t* wire);

/*@ requires \valid(s) && count <= 243; assigns *s \from *s, count, now_ms; ensures s->count <= 245; */
void segment_split_begin(segment_splitter_t* s, uint16_t count, uint32_t now_ms);

/*@ requires \valid_read(s) && \valid(frame) && \initialized(&frame->length) && frame->length <= 8;
    assigns frame->data[0 .. 7], frame->length, \result \from *s;
    ensures 0 <= frame->length <= 8;
    ensures \result == 0 || \result == 1; */
bool segment_split_peek(const segment_splitter_t* s, hal_can_frame_t* frame);

/*@ requires \valid(s); assigns *s \from *s, now_ms; ensures s->count <= 245; */
void segment_split_advance(segment_splitter_t* s, uint32_t now_ms);

#endif
