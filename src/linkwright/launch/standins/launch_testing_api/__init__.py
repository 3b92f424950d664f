"""The API of ``launch_testing`` and ``launch_testing_ros``.

Tests of ``unittest`` run during a launch and after it.
"""
