"""``launch_testing`` and ``launch_testing_ros``: tests of ``unittest`` that run during a launch and after its end."""
