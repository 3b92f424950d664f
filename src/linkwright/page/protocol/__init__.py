"""The messages between server and page, in a module for each subject.

Control messages are JSON objects with a ``type``. The TypeScript types in ``frontend/src/protocol/`` are generated from
this package by ``tools/protocol_types.py``. Transforms and the content of displays are sent as binary frames, packed
by `pack_transforms` and `pack_data`. A frame that is too large for its connection is sent in chunks, packed by
`pack_chunk`. Lengths are in meters, angles in radians, quaternions are x, y, z, w, and colors are from 0 to 1.

The page opens one WebSocket at ``/ws`` (same origin, with the token in the query). `Hello` is sent first, then `Tree`,
the `RobotScene` of every RobotModel, `ViewState`, `Joints`, `JointPositions`, `Diagnostics`, `FrameTable` and the last
transforms. After that, only changes are sent. A binary frame whose revision differs from the last `FrameTable` must be
ignored.

Of the messages queued for a slow page, only the newest of each class is sent. For a class with ``NEWEST_OF``, the
newest message is sent for each value of the fields that it names.

Property IDs are ``global/<name>`` or ``<display id>/<name>/<name>...``: the names of the rows on the path, joined by
``/``. In a name, ``%`` is written as ``%25`` and ``/`` as ``%2F``. The page requests a change with `SetProperty`, and
shows the new value when `PropertyChanged` (or new rows) arrives. The response to a rejected value contains the current
value.
"""
