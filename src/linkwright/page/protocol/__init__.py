"""The messages between server and page, each declared once, in the module of its subject.

Control messages are JSON objects with a ``type``; the TypeScript types in ``frontend/src/protocol/`` are generated from
this package by ``tools/protocol_types.py``. Transforms are sent as one binary frame, packed by `pack_transforms`, and
so is the content of displays, packed by `pack_data`; a frame that is too large for its line is sent in pieces,
packed by `pack_piece`. Lengths are metres, angles radians, quaternions x, y, z, w, colours 0 to 1.

The page opens one WebSocket at ``/ws`` (same origin, with the token in the query). `Hello` comes first,
then `Tree`, the `RobotScene` of every RobotModel, `ViewState`, `Joints`, `JointPositions`, `Diagnostics`, `FrameTable`
and the last transforms; after that whatever changes, where only the newest of a kind waits for a slow page. A binary
frame whose revision is not that of the last `FrameTable` is to be dropped.

Of messages that wait for a slow page only the newest of a class is sent, or, where a class has ``NEWEST_OF``, the
newest for each value of the fields named there.

Property ids are ``global/<name>`` or ``<display id>/<name>/<name>...``: the names of the rows on the way, joined by
``/``; in a name ``%`` is written ``%25`` and ``/`` is ``%2F``. The page requests a change with `SetProperty` and shows
it when `PropertyChanged` (or new rows) arrives; the answer to a refused value has the current one.
"""
