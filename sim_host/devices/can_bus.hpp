// A CAN bus with its nodes: arbitration, length of frames, acknowledgment, errors.
//
// A frame begins when the line is free and somebody offers one; the smallest identifier of those who offer wins. It
// succeeds when at least one other node of the same bit rate acknowledges. A node with another bit rate that is not
// error passive destroys every frame. The line is free again three bits after a frame, and eight bits later for a
// passive node that has just sent. Simplified: nodes join at any tick, not at bit edges; receivers take a frame at the
// last bit of its end; an error flag has six bits, twelve when others answer it.
//
// Faults that can be put on it: a node is unplugged (it hears itself but nobody else), frames are destroyed, the wires
// are shorted. A load generator keeps the line busy with a frame of any priority.
//
// Time: the owner calls run_event(next_event()) in order with everything else; ticks of 10 ns.

#ifndef STILLSPIN_SIM_HOST_DEVICES_CAN_BUS_HPP
#define STILLSPIN_SIM_HOST_DEVICES_CAN_BUS_HPP

#include <cstdint>
#include <list>
#include <vector>

#include "sim_host/chip/world.hpp"

namespace stillspin::devices {

using chip::CanError;
using chip::CanFrame;
using chip::CanNode;
using chip::Tick;

/// One piece of wire. Nodes that cannot hear each other are on different ones.
class CanSegment {
 public:
  void add(CanNode& node, Tick t);
  /// A node that goes while a frame is on the wire breaks its own frame or loses another's.
  void remove(CanNode& node, Tick t);
  /// Without a word to the node.
  void forget(const CanNode& node);
  bool has(const CanNode& node) const;
  void changed(Tick t);
  Tick next_event() const { return next_event_; }
  void run_event(Tick t);

  void destroy_frames(unsigned count) { to_destroy_ = count; }
  void short_wires(bool on, Tick t);
  Tick busy_ticks() const { return busy_ticks_; }
  std::uint64_t frames() const { return frames_; }
  std::uint64_t broken_frames() const { return broken_frames_; }

 private:
  struct Member {
    CanNode* node;
    Tick not_before = 0;  // for sending
    bool sends = false;   // the present frame
    bool hears = false;   // has been there from its start
  };
  enum class State { kFree, kFrame, kShorted };

  void look(Tick t);
  Tick earliest_start(Tick t) const;
  void begin_frame(Tick t);
  bool choose_sender(Tick t);
  int judge();
  int break_at(int bits, CanError error);
  bool heard_by_others() const;
  bool disturbed() const;
  void end_frame(Tick t);
  void deliver(Tick t);
  void suffer_short(Tick t);
  void release_line(Tick recessive_since, Tick t);

  std::vector<Member> members_;
  State state_ = State::kFree;
  CanFrame frame_;
  Tick bit_ = 0;
  Tick free_at_ = 0;
  Tick quiet_since_ = 0;
  bool collision_ = false;
  bool failed_ = false;
  CanError sender_error_ = CanError::kBit;
  bool in_delivery_ = false;
  unsigned to_destroy_ = 0;
  Tick begun_ = 0;
  Tick busy_ticks_ = 0;
  std::uint64_t frames_ = 0;
  std::uint64_t broken_frames_ = 0;
  Tick next_event_ = chip::kNever;
};

class CanBus final : public chip::CanLine {
 public:
  void attach(CanNode& node, std::int64_t t) override;
  void detach(CanNode& node) override;
  void changed(CanNode& node, std::int64_t t) override;

  Tick next_event() const;
  void run_event(Tick t);

  /// Takes the node off the others' wires, or puts it back.
  void set_plugged(CanNode& node, bool plugged, Tick t);
  /// The next `count` frames on the common wires end in an error.
  void destroy_frames(unsigned count) { common_.destroy_frames(count); }
  void short_wires(bool on, Tick t) { common_.short_wires(on, t); }

  /// Of the common wires.
  Tick busy_ticks() const { return common_.busy_ticks(); }
  std::uint64_t frames() const { return common_.frames(); }
  std::uint64_t broken_frames() const { return common_.broken_frames(); }

 private:
  struct Alone {
    CanNode* node;
    CanSegment wire;
  };
  std::list<Alone>::iterator find_alone(const CanNode& node);

  CanSegment common_;
  std::list<Alone> alone_;
};

}  // namespace stillspin::devices

#endif
