"""Right and wrong solutions, with which `linkwright learn test` tests the checks."""

from linkwright.learning import Edit, right, wrong

CASES = [
    right("one-link", "with an origin", Edit("robot.urdf", "<geometry>", '<origin xyz="0 0 0.25"/><geometry>')),
    right("one-link", "another number", Edit("robot.urdf", "0.5 0.5 0.5", "5e-1 .5 0.500")),
    wrong("one-link", "another name", Edit("robot.urdf", '"box"', '"bax"'), says="there is 'bax'"),
    wrong("one-link", "too small", Edit("robot.urdf", "0.5 0.5 0.5", "0.5 0.5 0.05"), says="size z is 0.05 m"),
    wrong("one-link", "no file", {"robot.urdf": None}, says="no file 'robot.urdf'"),
    wrong("mass", "an area", says="the area of a side", answer="25"),
    wrong("mass", "a word", says="is not a number", answer="heavy"),
]
