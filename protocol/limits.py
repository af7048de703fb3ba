"""The numbers both peers enforce. A peer that passes one is told `too_large`, never obeyed.

Sizes are in bytes. Both peers give the websocket library the matching `max_size`.
"""

INBOUND_MAX_BYTES = 1 << 20
"""Largest message a service accepts."""

OUTBOUND_MAX_BYTES = 2 << 20
"""Largest message a client accepts."""

PART_BYTES = 256 << 10
"""Largest data field of one part of something large, so that control messages never wait long."""

MAX_CELLS = 1 << 26
"""Largest number of cells of a grid."""

MAX_SIDE = 1 << 16
"""Largest number of rows or columns of a grid."""

MAX_FRAME_BYTES = 2 * MAX_CELLS + (1 << 20)
"""Largest packed frame, put together from its parts."""

MAX_TERRAIN_BYTES = 4 * MAX_CELLS + (1 << 20)
"""Largest compressed terrain, put together from its parts."""

MAX_IMAGERY_BYTES = 32 << 20
"""Largest picture of the terrain, put together from its parts."""

MAX_IMAGERY_SIDE = 4096
"""Most pixels along a side of a colour picture of the terrain."""

MAX_STATE_BYTES = 1 << 15
"""Largest packed block states of one frame (two bits a block)."""

MAX_BED_CELLS = 1 << 16
"""Most cells whose bed a frame tells: what breaches have lowered."""

MAX_CHANNEL_BYTES = 8 * MAX_CELLS + (1 << 20)
"""Largest channel of one frame, packed or unpacked."""

MAX_ARRAY_LENGTH = 4096
"""Most items of an array."""

MAX_SERIES_BYTES = 64 << 20
"""Most bytes of each kind of numbers in one answer with series; a longer one is asked for in stretches."""

MAX_SERIES_PLACES = MAX_ARRAY_LENGTH
"""Most gauges, and most sections, of a series."""

MAX_PLACES = 256
"""Most gauges, and most sections, that a client is told the places of."""

MAX_PLACE_POINTS = 128
"""Most vertices of a section that a client is told; longer ones are thinned."""

MAX_PARTS = MAX_CHANNEL_BYTES // PART_BYTES + 1
"""Largest number of parts of one frame, terrain or channel."""

MAX_DEPTH = 8
"""Deepest nesting of arrays and maps in a message."""

MAX_MAP_LENGTH = 64
"""Most entries of a map."""

MAX_STRING_BYTES = 8192
"""Longest string."""

INBOUND_MAX_ITEMS = 20_000
"""Most values, keys and containers in one message to a service (an edit of 4096 vertices has 16 400)."""

OUTBOUND_MAX_ITEMS = 300_000
"""Most values, keys and containers in one message to a client (a full edit list has about 150 000)."""

MAX_VERTICES = 4096
"""Most vertices of one edit."""

MAX_EDITS = 1024
"""Most edits in the working list of a run."""

MAX_LOG_VERTICES = 32_768
"""Most vertices of all edits in the working list of a run."""

MAX_HISTORY_VERTICES = 1 << 18
"""Most vertices of all changes of a working list that can be undone or redone; the oldest are forgotten."""

MAX_EDITS_AT_ONCE = 128
"""Most edits of one `append_edits`."""

MAX_EDIT_WORK = 1 << 22
"""Most cells (for an area: crossings of sides and rows) that the raster of one edit may look at."""

MAX_FORCING_ITEMS = 256
"""Most items of forcing of a case that a client is told of and may change."""

MAX_FORCING_CHANGES = 256
"""Most changes in the working forcing of a run."""

MAX_FORCING_POINTS = 4096
"""Most entries of all series in the working forcing of a run."""

MAX_ITEM_POINTS = 256
"""Most entries of the case's own series of one item; longer ones are thinned."""

MAX_PENDING_COMMANDS = 64
"""Most commands a client may have unanswered."""

DEFAULT_CREDIT = 2
"""Frames a new subscription may be sent before the first `credit`."""

MAX_CREDIT = 64
"""Most frames a client may have granted and not received; what is granted beyond is lost."""

KEY_FRAMES_KEPT = 4
"""Key frames a client keeps: the latest it received. A service sends an older one again before its delta."""

FRAME_GROUP = 32
"""Most frames that share one key frame, itself included."""

MAX_VIEWS_PER_S = 20
"""Views a session may present in a second."""
