"""``launch_testing`` and ``launch_testing_ros``: tests during and after a launch.

The tests are those of ``unittest``.
"""
