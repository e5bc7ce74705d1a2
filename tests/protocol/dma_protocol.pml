// The DMA protocol of core as a Promela model: one core, one DMA engine that ends pending transfers in any order.
// Run by tools/checks/check_protocol, which puts constants.h (tags, counts and pieces, taken from core's headers) beside
// it. LEVEL: which buffers; DEPTH: how many of each; PIECES: most pieces of a transfer; BREAK: what is done wrong;
// TRACE: only runs whose calls are those of trace.h, which the code itself made; CYCLES: for endless runs.
// Source: the functions of core named at each part; README.md tells what is left out.
// SPDX-License-Identifier: Apache-2.0
#include "constants.h"

// LEVEL.
#define TRIANGLES 1    // PacketDriver's triangle ring, cells appearing from nowhere
#define CELL_BLOCKS 2  // PacketDriver's macrocell ring, triangles left out
#define OUTPUT 3       // TileRenderer's output slots, the tracing left out
#define DRIVER 4       // PacketDriver: both rings
#define TILE 5         // TileRenderer with PacketDriver: all three
#define LISTS 6        // TreeSource: nodes and leaves for lists of rays
#define GATHER 7       // gather_records
#define SPILL 8        // RayQueue
#define EYES 9         // TileRenderer with TreeSource: tiles through the tree

// BREAK: nothing, or one thing done wrong. Each must be found; 13 is no wrong access but a standstill.
#define NOTHING 0
#define NO_WAIT 1           // the first wait of the level is left out
#define WRONG_TAG 2         // ... or waits for the next buffer's tag; in OUTPUT for the first's
#define FEWER_BUFFERS 3     // one buffer fewer than the ring thinks
#define EARLY_GET 4         // a buffer is fetched anew while it is in use
#define SOURCE_CHANGED 5    // a tile is drawn before the slot's last one has left
#define SHARED_TAG 6        // all buffers of the level under the first one's tag
#define NO_ROOM 7           // Transfers does not look whether the queue has room
#define FORGETS 8           // Transfers does not wait for the oldest tag but takes it off its list
#define NO_FINISH 9         // the last tiles are not waited for
#define SMALL_SHARE 10      // the output's share is one command less than may be leaving while a tile is traced
#define STALE_RECORD 11     // a gather takes the slot it fetched last for the one it waited for
#define SPILL_NO_WAIT 12    // a queue's place is used again before its block has left
#define STANDSTILL 13       // the driver wants one more run than its ring holds
#define NO_POP 14           // the driver tests the same run for ever

#ifndef BREAK
#define BREAK NOTHING
#endif
#ifndef PIECES
#define PIECES 2
#endif
#ifndef MOST_QUEUE
#define MOST_QUEUE 8
#endif

#define HAS_TRIANGLES (LEVEL == TRIANGLES || LEVEL == DRIVER || LEVEL == TILE)
#define HAS_BLOCKS (LEVEL == CELL_BLOCKS || LEVEL == DRIVER || LEVEL == TILE)
#define HAS_DRIVER (HAS_TRIANGLES || HAS_BLOCKS)
#define HAS_OUTPUT (LEVEL == OUTPUT || LEVEL == TILE || LEVEL == EYES)
#define HAS_TREE (LEVEL == LISTS || LEVEL == EYES)

#if DEPTH > K_MACRO_TAG_COUNT || DEPTH > K_TRIANGLE_TAG_COUNT || DEPTH > K_OUTPUT_TAG_COUNT
#error "more buffers than the level has tags"
#endif
#if K_TAG_COUNT != 32
#error "the model's arrays are made for 32 tags"
#endif

#if HAS_TREE
// Slots for nodes and leaves, DEPTH of them, or as many as the code's. There are fewer tags, which go round; OWN_TAGS:
// as many.
#ifndef SLOTS
#define SLOTS DEPTH
#endif
#ifdef TRACE
#define CHILD_TAGS K_MACRO_TAG_COUNT
#else
#define CHILD_TAGS ((SLOTS + 1) / 2)
#endif
#define SETUP_BUFFER SLOTS
#define TILE_OF(slot) (SLOTS + 1 + (slot))
#if LEVEL == EYES
#define BUFFERS (SLOTS + 1 + DEPTH)
#else
#define BUFFERS (SLOTS + 1)
#endif
#else
// Buffers: blocks, triangles, tiles, and the place that setup transfers go to.
#define BLOCK(slot) (slot)
#define RUN(slot) (DEPTH + (slot))
#define TILE_OF(slot) (2 * DEPTH + (slot))
#define SETUP_BUFFER (3 * DEPTH)
#define BUFFERS (3 * DEPTH + 1)
#endif

#if BREAK == SHARED_TAG
#define TAG_OF(first, slot) (first)
#else
#define TAG_OF(first, slot) ((first) + (slot))
#endif
#if BREAK == WRONG_TAG && LEVEL == OUTPUT
// The next slot's tag would do no harm: each tile would wait for one that began later than the slot's own, which the
// tiles before it have waited for.
#define WAITED_TAG(first, slot) (first)
#elif BREAK == WRONG_TAG
#define WAITED_TAG(first, slot) ((first) + ((slot) + 1) % DEPTH)
#else
#define WAITED_TAG(first, slot) TAG_OF(first, slot)
#endif
#if BREAK == FEWER_BUFFERS
#define PLACE(slot) ((slot) % (DEPTH - 1))
#else
#define PLACE(slot) (slot)
#endif

// What a buffer holds is told by a serial number; of as many as a ring can confuse.
#define SERIALS DEPTH
#define GARBAGE 255

// --- Transfers: core/gridiron/dma/transfers.h ------------------------------------------------------------------

byte queue_depth, output_share;
byte pending[32];    // pending_
byte rank[32];       // order of started_: 1 is the tag that began longest ago; 0: none of it pending
byte ranked, pending_count;

// --- The platform and its engine: platform/gridiron/platform/contract.h ------------------------------------------

byte total;          // commands that were started and not waited for
byte issued[32];     // ... by tag
byte moving[32];     // those of them that the engine has not ended
#if HAS_TREE
byte moving_of[BUFFERS];  // ... by buffer
#else
byte owner[32];      // buffer whose bytes a tag's pending commands move
#endif
byte busy[BUFFERS];  // tag + 1 that moves a buffer's bytes and was not waited for; 0: none
bool is_put[BUFFERS];
byte left[BUFFERS];  // pieces of a get that the engine has not moved
byte wanted[BUFFERS], content[BUFFERS], sent[BUFFERS];
bool in_use[BUFFERS];
bool is_over;

// The core goes on alone between its calls, as nothing it does there meets the engine but what begin_use checks. At
// each call, and where it learns what the scene holds, the engine may end any number of commands.
bool yields;
#ifdef TRACE
#define YIELD skip
#else
#define YIELD yields = true; !yields
#endif
// CYCLES: a run that never ends must have the scene say something new again and again, which is progress.
#ifdef CYCLES
bool has_decided;
#define NOTED(what) has_decided = true
#define DECIDED(what) has_decided = true; YIELD
#else
#define NOTED(what) skip
#define DECIDED(what) YIELD
#endif

byte of_tag;  // argument and result of C code
hidden byte t_, place_;

c_decl {
\#include "constants.h"
}

#define IS_COUNTED(tag) (output_share == 0 || (tag) < K_FIRST_OUTPUT_TAG)

#ifdef TRACE
c_decl {
\#include "trace.h"
}
short position;
byte called;
#define CALLED(kind, tag) \
  called = (kind) * 32 + (tag); \
  c_expr { now.position < kTraceCount && kTrace[now.position] == now.called }; \
  position++
#else
#define CALLED(kind, tag) skip
#endif
#define WAIT_CALL 0
#define GET_CALL 1
#define PUT_CALL 2

// P::wait: ends when the engine has ended all of the tag.
inline platform_wait(tag) {
  atomic {
    CALLED(WAIT_CALL, tag);
    moving[tag] == 0;
#if HAS_TREE
    for (t_ : 0 .. BUFFERS - 1) {
      if :: busy[t_] == (tag) + 1 -> busy[t_] = 0; is_put[t_] = false; sent[t_] = 0 :: else fi
    }
    t_ = 0;
    total = total - issued[tag];
    issued[tag] = 0;
#else
    if
    :: issued[tag] != 0 -> busy[owner[tag]] = 0; is_put[owner[tag]] = false; sent[owner[tag]] = 0; total = total - issued[tag]; issued[tag] = 0; owner[tag] = 0
    :: else
    fi;
#endif
    YIELD
  }
}

// P::get and P::put of one piece. A tag's pending commands are those of one buffer, but of the tree's slots; a buffer in
// flight or in use is not started on; there is room in the queue.
inline platform_start(put, buffer, tag, is_first) {
  atomic {
    CALLED((put -> PUT_CALL : GET_CALL), tag);
    assert(total < queue_depth);
#if !HAS_TREE
    assert(issued[tag] == 0 || owner[tag] == buffer);
#endif
    assert(busy[buffer] == 0 || (busy[buffer] == (tag) + 1 && !(is_first)));
    assert(!in_use[buffer]);
    total++;
    issued[tag]++;
#ifdef TRACE
    if :: !(put) && left[buffer] == 1 -> content[buffer] = wanted[buffer]; wanted[buffer] = 0 :: else fi;
    if :: !(put) -> left[buffer]-- :: else fi;
#else
    moving[tag]++;
#if HAS_TREE
    moving_of[buffer]++;
#endif
#endif
#if !HAS_TREE
    owner[tag] = buffer;
#endif
    busy[buffer] = (tag) + 1;
    is_put[buffer] = put;
    if :: put -> sent[buffer] = content[buffer] :: else fi;
    YIELD
  }
}

// The engine moves the bytes of one pending command of a tag: those of a put are read now, those of a get arrive.
#if HAS_TREE
inline end_one_of(buffer) {
  d_step {
    moving_of[buffer] != 0;
    assert(!in_use[buffer]);
    if
    :: is_put[buffer] -> assert(content[buffer] == sent[buffer])
    :: else ->
      left[buffer]--;
      if :: left[buffer] == 0 -> content[buffer] = wanted[buffer]; wanted[buffer] = 0 :: else fi
    fi;
    moving_of[buffer]--;
    moving[busy[buffer] - 1]--
  }
}
#else
inline end_one(tag) {
  d_step {
    moving[tag] != 0;
    place_ = owner[tag];
    assert(!in_use[place_]);
    if
    :: is_put[place_] -> assert(content[place_] == sent[place_])
    :: else ->
      left[place_]--;
      if :: left[place_] == 0 -> content[place_] = wanted[place_]; wanted[place_] = 0 :: else fi
    fi;
    moving[tag]--
  }
}
#endif

// Transfers::wait.
inline wait(tag) {
  atomic {
    if :: IS_COUNTED(tag) -> pending_count = pending_count - pending[tag] :: else fi;
    forget(tag);
    platform_wait(tag)
  }
}
inline forget(tag) {
  d_step {
    of_tag = tag;
    c_code {
      if (now.pending[now.of_tag] != 0) {
        for (int i = 0; i < 32; i++) {
          if (now.rank[i] > now.rank[now.of_tag]) now.rank[i]--;
        }
        now.rank[now.of_tag] = 0;
        now.ranked--;
        now.pending[now.of_tag] = 0;
      }
      now.of_tag = 0;
    }
  }
}

// Transfers::make_room.
inline make_room(tag) {
  atomic {
    if
#if BREAK != NO_ROOM
    :: IS_COUNTED(tag) && pending_count >= queue_depth - output_share ->
      d_step {
        c_code {
          int found = 0;
          for (int i = 0; i < 32; i++) {
            const int is_counted = now.output_share == 0 || i < K_FIRST_OUTPUT_TAG;
            if (now.rank[i] != 0 && is_counted && (now.rank[found] == 0 || now.rank[i] < now.rank[found])) found = i;
          }
          now.of_tag = found;
        }
        oldest = of_tag;
        of_tag = 0
      }
#if BREAK == FORGETS
      pending_count = pending_count - pending[oldest];
      forget(oldest);
#else
      wait(oldest);
#endif
      oldest = 0
#endif
    :: else
    fi;
    d_step {
      if :: pending[tag] == 0 -> ranked++; rank[tag] = ranked :: else fi;
      pending[tag]++;
      if :: IS_COUNTED(tag) -> pending_count++ :: else fi
    }
  }
}

// Transfers::get, cut into 1 .. most pieces.
inline get(buffer, tag, serial, most) {
  atomic {
    select(pieces : 1 .. most);
    wanted[buffer] = serial;
    content[buffer] = GARBAGE;
    left[buffer] = pieces;
    piece = 0
  }
  do
  :: piece < pieces -> make_room(tag); platform_start(false, buffer, tag, piece == 0); piece++
  :: else -> break
  od;
  pieces = 0; piece = 0
}

// Transfers::put of a tile's planes, in 1 .. most commands under one tag.
inline put(buffer, tag, most) {
  select(pieces : 1 .. most);
  piece = 0;
  do
  :: piece < pieces -> make_room(tag); platform_start(true, buffer, tag, piece == 0); piece++
  :: else -> break
  od;
  pieces = 0; piece = 0
}

// A get or put that is waited for at once: chunks of the table, materials, lights, surfaces of a tie.
inline get_now() {
  get(SETUP_BUFFER, K_SETUP_TAG, 0, PIECES);
  wait(K_SETUP_TAG);
  begin_use(SETUP_BUFFER, 0);
  end_use(SETUP_BUFFER)
}

// The core looks into a buffer, or draws in it: only when nothing of it is in flight, and it holds what it should.
inline begin_use(buffer, serial) {
  d_step {
    assert(busy[buffer] == 0);
    assert(content[buffer] == serial);
    in_use[buffer] = true
  }
}

// What it held is done with.
inline end_use(buffer) {
  d_step { in_use[buffer] = false; content[buffer] = GARBAGE }
}

// --- PacketDriver: core/gridiron/engine/grid/packet_driver.h -----------------------------------------------------------

#if HAS_DRIVER
// BufferRing: front_ and used_ of either ring, and the serials that tell what it handed out.
byte block_front, block_used, run_front, run_used;
byte block_serial, run_serial;  // of the next get
bool cell_left, entered, walking, blocks_done, cells_done;

#define SLOT(front, used) (((front) + (used)) % DEPTH)

// fetch_next_macro_cell: the table's chunks on the way, the end of the walk, or a get.
inline fetch_next_macro_cell() {
  do
  :: true -> NOTED(chunk); get_now()
  :: true -> NOTED(end); blocks_done = true; break
  :: true ->
    NOTED(block);
    slot = SLOT(block_front, block_used);
    block_used++;
    get(BLOCK(PLACE(slot)), TAG_OF(K_FIRST_MACRO_TAG, slot), block_serial, PIECES);
    block_serial = (block_serial + 1) % SERIALS;
    break
  od;
  slot = 0
}

// enter_next_macro_cell.
inline enter_next_macro_cell() {
#if BREAK == EARLY_GET && LEVEL == CELL_BLOCKS
  in_use[BLOCK(block_front)] = entered;
#endif
  if :: entered -> block_front = (block_front + 1) % DEPTH; block_used-- :: else fi;
  entered = false;
  do
  :: block_used != DEPTH && !blocks_done -> fetch_next_macro_cell()
  :: else -> break
  od;
#if BREAK == EARLY_GET && LEVEL == CELL_BLOCKS
  in_use[BLOCK((block_front + DEPTH - 1) % DEPTH)] = false;
#endif
  if
  :: block_used == 0 -> cells_done = true
  :: else ->
#if !(BREAK == NO_WAIT && LEVEL == CELL_BLOCKS)
    wait(WAITED_TAG(K_FIRST_MACRO_TAG, block_front));
#endif
    entered = true;
    walking = true
  fi
}

// find_next_cell looks into the front block, squares_that_see at its cell.
inline find_next_cell() {
  begin_use(BLOCK(PLACE(block_front)), (block_serial + SERIALS - block_used) % SERIALS);
  in_use[BLOCK(PLACE(block_front))] = false;
  if
  :: true -> DECIDED(cell); cell_left = true
  :: true -> DECIDED(unseen)
  :: true -> NOTED(no_cell); walking = false
  fi
}

// fetch_next_run.
inline fetch_next_run() {
  if :: cell_left -> NOTED(beyond); cell_left = false :: true fi;
  do
  :: !cell_left && !cells_done ->
#if HAS_BLOCKS
    if
    :: walking -> find_next_cell()
    :: else -> enter_next_macro_cell()
    fi
#else
    if
    :: true -> DECIDED(cell); cell_left = true
    :: true -> cells_done = true
    fi
#endif
  :: else -> break
  od;
  if
  :: cells_done
  :: else ->
    if :: cell_left = false :: true -> DECIDED(run) fi;  // the cell's last run, or not
#if HAS_TRIANGLES
    slot = SLOT(run_front, run_used);
    run_used++;
    get(RUN(PLACE(slot)), TAG_OF(K_FIRST_TRIANGLE_TAG, slot), run_serial, PIECES);
    run_serial = (run_serial + 1) % SERIALS;
    slot = 0
#endif
  fi
}

// test_front_run, with the records of a lattice spread in place.
inline test_front_run() {
#if !(BREAK == NO_WAIT && LEVEL != CELL_BLOCKS)
  wait(WAITED_TAG(K_FIRST_TRIANGLE_TAG, run_front));
#endif
  if
  :: true -> skip  // every ray has hit something in front of it
  :: true ->
    begin_use(RUN(PLACE(run_front)), (run_serial + SERIALS - run_used) % SERIALS);
#if BREAK == EARLY_GET
    if
    :: run_used == DEPTH && !cells_done ->
      get(RUN(run_front), TAG_OF(K_FIRST_TRIANGLE_TAG, run_front), run_serial, PIECES)
    :: else
    fi;
#endif
    end_use(RUN(PLACE(run_front)))
  fi;
#if BREAK != NO_POP
  run_front = (run_front + 1) % DEPTH;
  run_used--
#endif
}

// run: a driver of its own for each pass. Nothing of it is in flight when it ends.
inline run_driver() {
  do
  :: !cells_done && run_used != DEPTH -> fetch_next_run()
#if BREAK == STANDSTILL
  :: !cells_done && run_used == DEPTH -> run_used != DEPTH
#endif
  :: else ->
#if HAS_TRIANGLES
    if
    :: run_used == 0 -> break
    :: else -> test_front_run()
    fi
#else
    break
#endif
  od;
  skip;
  d_step {
    for (t_ : 0 .. 2 * DEPTH - 1) {
      assert(busy[t_] == 0);
      content[t_] = GARBAGE
    }
    t_ = 0;
    block_front = 0; run_front = 0; block_serial = 0; run_serial = 0;
    blocks_done = false; cells_done = false
  }
}
#endif

// --- TreeSource: core/gridiron/engine/tree/tree_source.h -----------------------------------------------------------------

#if HAS_TREE
// What was fetched stays in its slot, to be used again, until the slot is fetched anew. Which slot makes room is a free
// choice; in core it is one of a set.
mtype = { kNothing, kNode, kLeaf };
mtype has[SLOTS];
bool is_pending[SLOTS];
bit serial[SLOTS];    // of what a slot has, or will have
byte tag_at[SLOTS];   // of its transfer
byte fetched;         // children, as far as tags tell them apart
#ifdef TRACE
byte next;
#endif

// arrive.
inline arrive(i) {
#if BREAK != NO_WAIT
  wait(tag_at[i]);
#endif
  is_pending[i] = false
}

#ifdef TRACE
// Slots that are not pending differ in no call, nor do those with one tag. A slot that makes room while it is pending
// calls as one that is taken before.
inline choose_slot(i) {
  d_step {
    i = 0;
    do
    :: i < SLOTS && is_pending[next] -> next = (next + 1) % SLOTS; i++
    :: else -> break
    od
  }
  i < SLOTS;
  i = next;
  next = (next + 1) % SLOTS
}
// Which is used of those at hand: one that the next call may be a wait for; any leaf, for a tie.
inline choose_child(i) {
  if
  :: d_step {
       c_code { now.called = now.position < kTraceCount ? kTrace[now.position] : 255; }
       i = 0;
       do
       :: i < SLOTS && !(is_pending[i] && tag_at[i] == called) -> i++
       :: else -> break
       od
     }
  :: d_step {
       i = 0;
       do
       :: i < SLOTS && !(!is_pending[i] && has[i] == kLeaf) -> i++
       :: else -> break
       od
     }
  fi;
  i < SLOTS
}
// One that the next call may be a wait for.
inline choose_other(i) {
  d_step {
    c_code { now.called = now.position < kTraceCount ? kTrace[now.position] : 255; }
    i = 0;
    do
    :: i < SLOTS && !(is_pending[i] && tag_at[i] == called) -> i++
    :: else -> break
    od
  }
  i < SLOTS
}
#else
#define choose_slot(i) select(i : 0 .. SLOTS - 1)
#define choose_child(i) select(i : 0 .. SLOTS - 1)
#define choose_other(i) select(i : 0 .. SLOTS - 1)
#endif

#ifdef OWN_TAGS
#define TAG_NUMBER(i) (i)
#else
#define TAG_NUMBER(i) fetched
#endif

// start.
inline start_child(i) {
  choose_slot(i);
  if
#if BREAK != EARLY_GET
  :: is_pending[i] -> arrive(i)
  :: else
#else
  :: true
#endif
  fi;
  if
  :: has[i] = kNode; tag_at[i] = K_FIRST_MACRO_TAG + TAG_NUMBER(i)
  :: has[i] = kLeaf; tag_at[i] = K_FIRST_TRIANGLE_TAG + TAG_NUMBER(i)
  fi;
  fetched = (fetched + 1) % CHILD_TAGS;
  serial[i] = 1 - serial[i];
  is_pending[i] = true;
  get(i, tag_at[i], 1 + serial[i], PIECES)
}

// What is done with a child: triangles for ties. A tile's hits also need those of other leaves at hand.
inline use_child() {
  begin_use(slot, 1 + serial[slot]);
  do
  :: has[slot] == kLeaf -> NOTED(tie); get_now()  // comes_before, record
#if LEVEL == EYES
  :: has[slot] == kLeaf ->
    DECIDED(record);
    choose_other(other);
    if
    :: other != slot && has[other] == kLeaf ->
      if :: is_pending[other] -> arrive(other) :: else fi;
      begin_use(other, 1 + serial[other]);
      in_use[other] = false
    :: else
    fi;
    other = 0
#endif
  :: true -> break
  od;
  in_use[slot] = false
}

// trace of lists; steps of the tiles that take turns.
inline trace_children() {
  do
  :: true -> DECIDED(ahead); start_child(slot); slot = 0  // ahead: a child that is not at hand
  :: true ->                                    // node, leaf
    DECIDED(take);
    if
    :: true -> start_child(slot)
    :: true -> choose_child(slot)
    fi;
    if
    :: has[slot] == kNothing
    :: else ->
      if :: is_pending[slot] -> arrive(slot) :: else fi;
      use_child()
    fi;
    slot = 0
#if LEVEL == EYES
  :: true -> DECIDED(record); get_now()
#endif
  :: true -> break
  od;
  slot = 0;  // finish
  do
  :: slot < SLOTS ->
    if :: is_pending[slot] -> arrive(slot) :: else fi;
    slot++
  :: else -> break
  od;
  slot = 0
}
// forget.
inline forget_children() {
  d_step {
    for (t_ : 0 .. SLOTS - 1) { has[t_] = kNothing; content[t_] = GARBAGE; serial[t_] = 0; tag_at[t_] = 0 }
    t_ = 0;
    fetched = 0
  }
}

#if LEVEL == EYES
inline trace_eyes() {
  forget_children();
  trace_children()
}
#else
inline run_lists() {
  forget_children();
#ifdef TRACE
  select(fetched : 0 .. CHILD_TAGS - 1);  // what other stages have fetched
#endif
  trace_children()
}
#endif
#endif

// --- TileRenderer: core/gridiron/render/tile_renderer.h ----------------------------------------------------------

#if HAS_OUTPUT
byte output_slot, tile_commands;  // most commands of one tile
byte tile_serial;
bool waits_for_output;

// share_queue.
inline share_queue() {
  d_step {
    waits_for_output = DEPTH == 1 || tile_commands * DEPTH + K_LEAST_INPUT_COMMANDS > queue_depth;
    if
    :: waits_for_output
#if BREAK == SMALL_SHARE
    :: else -> output_share = tile_commands * (DEPTH - 1) - 1
#else
    :: else -> output_share = tile_commands * DEPTH
#endif
    fi
  }
}

// render_tile.
inline render_tile() {
  atomic {
    drawn = output_slot;
    output_slot = (output_slot + 1) % DEPTH
  }
#if BREAK != SOURCE_CHANGED && !(BREAK == NO_WAIT && LEVEL == OUTPUT)
  wait(WAITED_TAG(K_FIRST_OUTPUT_TAG, drawn));
#endif
  begin_use(TILE_OF(PLACE(drawn)), content[TILE_OF(PLACE(drawn))]);
#if HAS_DRIVER
  do
  :: true -> DECIDED(packet); run_driver()
  :: true -> break
  od;
  skip;
#elif LEVEL == EYES
  trace_eyes();
#else
  // The tracing's transfers, as one that may fill what the output leaves of the queue.
  if
  :: true -> get(SETUP_BUFFER, K_SETUP_TAG, 0, K_LEAST_INPUT_COMMANDS + MOST_TILE_COMMANDS + 1); wait(K_SETUP_TAG)
  :: true
  fi;
#endif
  d_step {
    content[TILE_OF(PLACE(drawn))] = tile_serial;
    tile_serial = (tile_serial + 1) % SERIALS;
    in_use[TILE_OF(PLACE(drawn))] = false
  }
#if BREAK == SOURCE_CHANGED
  wait(WAITED_TAG(K_FIRST_OUTPUT_TAG, drawn));
#endif
  put(TILE_OF(PLACE(drawn)), TAG_OF(K_FIRST_OUTPUT_TAG, drawn), tile_commands);  // put_tile
  if
  :: waits_for_output -> wait(TAG_OF(K_FIRST_OUTPUT_TAG, drawn))
  :: else
  fi;
  drawn = 0
}

// run, and finish.
inline run_tiles() {
  get_now();  // the frame
  if
  :: true -> get_now()  // the macrocell table, where it fits; of a tree its record, then its first nodes
  :: true
  fi;
#if LEVEL == EYES
  get_now();
#endif
  share_queue();
  do
  :: true -> NOTED(tile); render_tile()
  :: true -> break
  od;
#if BREAK != NO_FINISH
  drawn = 0;
  do
  :: drawn < DEPTH ->
    wait(TAG_OF(K_FIRST_OUTPUT_TAG, output_slot));
    output_slot = (output_slot + 1) % DEPTH;
    drawn++
  :: else -> break
  od
#endif
}
#endif

// --- gather_records: core/gridiron/dma/record_gather.h ---------------------------------------------------------

#if LEVEL == GATHER
#ifndef ITEMS
#define ITEMS (DEPTH + 3)
#endif
byte list[ITEMS];  // 0: wants no record; 1, 2: neighbours that want the same one, or another
byte asked[DEPTH];  // wanted, by slot

inline gather() {
  i = 0;
  do
  :: i < ITEMS -> select(choice : 0 .. 2); list[i] = choice; i++
  :: else -> break
  od;
  i = 0; choice = 0;
  do
  :: i == ITEMS -> break
  :: i < ITEMS && list[i] == 0 -> i++
  :: i < ITEMS && list[i] != 0 ->
    if
    :: list[i] != at_hand && at_hand != 0 -> front = (front + 1) % DEPTH; used--
    :: else
    fi;
    do
    :: ahead < ITEMS && used != DEPTH ->
      if
      :: list[ahead] == 0 || list[ahead] == last
      :: else ->
        slot = (front + used) % DEPTH;
        used++;
        last = list[ahead];
        asked[slot] = last;
        get(RUN(PLACE(slot)), TAG_OF(K_FIRST_TRIANGLE_TAG, slot), last, PIECES)
      fi;
      ahead++
    :: else -> break
    od;
#if BREAK == STALE_RECORD
    front = slot;
#endif
    slot = 0;
    if
    :: list[i] != at_hand ->
#if BREAK != NO_WAIT
      wait(WAITED_TAG(K_FIRST_TRIANGLE_TAG, front));
#endif
      at_hand = list[i]
    :: else
    fi;
    begin_use(RUN(PLACE(front)), list[i]);
    if :: get_now() :: true fi;  // a material, a block of the queue
#if BREAK == EARLY_GET
    get(RUN(front), TAG_OF(K_FIRST_TRIANGLE_TAG, front), 2, PIECES);
#endif
    in_use[RUN(PLACE(front))] = false;
    i++
  od
}
#endif

// --- RayQueue: core/gridiron/shade/ray_queue.h -------------------------------------------------------------------

#if LEVEL == SPILL
// A block of rays is K_BLOCK_RAYS = 2 here, wave and ring as many blocks as in core. A ray is its place in the stack.
// Buffer b of the ring is RUN(b); DEPTH blocks go to main memory at most.
#define K_BLOCK_RAYS 2
#define RING_RAYS (K_QUEUE_BLOCKS * K_BLOCK_RAYS)
#define WAVE_RAYS (K_WAVE_BLOCKS * K_BLOCK_RAYS)
byte ring[RING_RAYS], main_memory[DEPTH * K_BLOCK_RAYS];
byte moved_first, moved_block;

inline spill_put() {
  put(SETUP_BUFFER, K_SETUP_TAG, PIECES)
}

inline run_queue() {
  do
  :: count + spilled * K_BLOCK_RAYS < (DEPTH + K_QUEUE_BLOCKS) * K_BLOCK_RAYS ->  // push
    DECIDED(push);
    if
    :: count == RING_RAYS ->
      content[SETUP_BUFFER] = ring[first];
      spill_put();
#if BREAK != SPILL_NO_WAIT
      wait(K_SETUP_TAG);
#endif
      d_step {
        main_memory[spilled * K_BLOCK_RAYS] = ring[first];
        main_memory[spilled * K_BLOCK_RAYS + 1] = ring[first + 1];
        spilled++;
        first = (first + K_BLOCK_RAYS) % RING_RAYS;
        count = count - K_BLOCK_RAYS
      }
    :: else
    fi;
    skip;
    d_step {
      // The only place that a put may still read is the block put last.
      assert(busy[SETUP_BUFFER] == 0 || (first + count) % RING_RAYS / K_BLOCK_RAYS != (first + RING_RAYS - K_BLOCK_RAYS) % RING_RAYS / K_BLOCK_RAYS);
      ring[(first + count) % RING_RAYS] = count + spilled * K_BLOCK_RAYS;
      count++
    }
  :: count + spilled != 0 ->  // pop_wave
    NOTED(pop);
    do
    :: spilled != 0 && count < WAVE_RAYS && count + K_BLOCK_RAYS <= RING_RAYS ->
      d_step {
        spilled--;
        first = (first + RING_RAYS - K_BLOCK_RAYS) % RING_RAYS;
        count = count + K_BLOCK_RAYS;
        ring[first] = GARBAGE;
        ring[first + 1] = GARBAGE
      }
      get(SETUP_BUFFER, K_SETUP_TAG, 0, PIECES);
      wait(K_SETUP_TAG);
      skip;
      d_step {
        assert(content[SETUP_BUFFER] == 0);
        ring[first] = main_memory[spilled * K_BLOCK_RAYS];
        ring[first + 1] = main_memory[spilled * K_BLOCK_RAYS + 1]
      }
    :: else -> break
    od;
    skip;
    d_step {
      taken = (count < WAVE_RAYS -> count : WAVE_RAYS);
      do
      :: taken != 0 ->
        count--;
        assert(ring[(first + count) % RING_RAYS] == count + spilled * K_BLOCK_RAYS);
        ring[(first + count) % RING_RAYS] = GARBAGE;
        taken--
      :: else -> break
      od;
      taken = 0
    }
  :: true -> break
  od
}
#endif

// --- Processes ---------------------------------------------------------------------------------------------------

active proctype core() {
  byte pieces, piece, oldest, slot;
#if LEVEL == EYES
  byte other;
#endif
#if HAS_OUTPUT
  byte drawn;
#endif
#if LEVEL == GATHER
  byte i, ahead, front, used, last, at_hand, choice;
#endif
#if LEVEL == SPILL
  byte first, count, spilled, taken;
#endif
  // Nothing meets the core where calls are given; what is not atomic is a state, so that loops are seen to close.
#ifdef TRACE
  {
#else
  atomic {
#endif
#ifdef TRACE
    queue_depth = TRACE_QUEUE;
#else
    select(queue_depth : 1 .. MOST_QUEUE);
#endif
#if HAS_OUTPUT
#ifdef TRACE
    tile_commands = TRACE_TILE_COMMANDS;
#else
    select(tile_commands : 1 .. MOST_TILE_COMMANDS);
#endif
  run_tiles();
#elif HAS_DRIVER
  do
  :: true -> DECIDED(pass); run_driver()
  :: true -> break
  od;
#elif LEVEL == LISTS
  run_lists();
#elif LEVEL == GATHER
  gather();
#elif LEVEL == SPILL
  run_queue();
#endif
  // All transfers have been waited for.
  skip;
  d_step {
    assert(total == 0);
    assert(pending_count == 0 && ranked == 0);
    is_over = true
  }
#ifdef TRACE
  assert(c_expr { now.position != kTraceCount })  // fails: all of trace.h was done
#endif
  }
}

#ifndef TRACE
#define END(tag) :: end_one(tag)
// One end for each buffer of a level.
#if DEPTH == 1
#define ENDS(first) END(first)
#elif DEPTH == 2
#define ENDS(first) END(first) END(first + 1)
#elif DEPTH == 3
#define ENDS(first) END(first) END(first + 1) END(first + 2)
#else
#define ENDS(first) END(first) END(first + 1) END(first + 2) END(first + 3)
#endif
#if HAS_TREE
#define END_OF(buffer) :: end_one_of(buffer)
#if DEPTH == 1
#define ENDS_FROM(first) END_OF(first)
#elif DEPTH == 2
#define ENDS_FROM(first) END_OF(first) END_OF(first + 1)
#elif DEPTH == 3
#define ENDS_FROM(first) END_OF(first) END_OF(first + 1) END_OF(first + 2)
#else
#define ENDS_FROM(first) END_OF(first) END_OF(first + 1) END_OF(first + 2) END_OF(first + 3)
#endif
#endif
active proctype engine() {
end_engine:
  do
#ifdef CYCLES
  :: yields && !has_decided -> yields = false
  :: yields && has_decided ->
progress_scene:
    has_decided = false;
    yields = false
#else
  :: yields -> yields = false
#endif
#if HAS_TREE
  END_OF(SETUP_BUFFER)
  ENDS_FROM(0)
#if LEVEL == EYES
  ENDS_FROM(SLOTS + 1)
#endif
#else
  END(K_SETUP_TAG)
#endif
#if HAS_BLOCKS
  ENDS(K_FIRST_MACRO_TAG)
#endif
#if HAS_TRIANGLES || LEVEL == GATHER
  ENDS(K_FIRST_TRIANGLE_TAG)
#endif
#if HAS_OUTPUT && !HAS_TREE
  ENDS(K_FIRST_OUTPUT_TAG)
#endif
  od
}
#endif
