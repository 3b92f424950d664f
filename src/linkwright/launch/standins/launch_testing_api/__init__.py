"""The API of ``launch_testing`` and ``launch_testing_ros``: unittest tests during and after a launch."""
