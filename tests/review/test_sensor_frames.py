"""The lines of a review about the frames of the messages of Gazebo's sensors, whose tags depend on the version."""

from __future__ import annotations

import pytest

from tests.review.conftest import subject

SENSOR = """<sensor name="eye" type="camera"><ignition_frame_id>eye_link</ignition_frame_id>
<camera><horizontal_fov>1</horizontal_fov></camera></sensor>"""
ROBOT = '<robot name="arm"><link name="eye_link"/><gazebo reference="eye_link">{}</gazebo></robot>\n'
FILES = {
    "arm/urdf/arm.urdf": ROBOT.format(SENSOR),
    "arm/models/arm.sdf": f'<sdf version="1.8"><model name="arm"><link name="eye_link">{SENSOR}</link></model></sdf>\n',
}
OPTICAL = "<camera><optical_frame_id>eye_optical</optical_frame_id>"
TAG, OTHER_TAG = "ignition_frame_id>", "gz_frame_id>"
REASON = "programs that look for the frame 'eye_link' in the messages do not find it"


@pytest.mark.parametrize("path", FILES)
@pytest.mark.parametrize(
    ("edits", "count", "frame"),
    [
        ([(f"<{TAG}eye_link</{TAG}", ""), ("<camera>", OPTICAL)], 1, "camera optical_frame_id eye_link -> eye_optical"),
        ([(TAG, OTHER_TAG), (">eye_link<", ">other<")], 1, "gz_frame_id eye_link -> other"),
        ([(TAG, OTHER_TAG)], 2, None),
    ],
)
def test_another_tag_of_the_frame_of_a_sensor(repository, compare, path, edits, count, frame):
    text = FILES[path]
    repository.commit({"arm/package.xml": "<package/>\n", path: text})
    for old, new in edits:
        text = text.replace(old, new)
    repository.write({path: text})
    changes = subject(compare(repository), path).changes
    assert len(changes) == count
    reasons = [str(change.reason) for change in changes if change.reason is not None]
    assert reasons == ([] if frame is None else [REASON])
    assert frame is None or str(changes[0].sentence).replace(":", "").endswith(frame)
