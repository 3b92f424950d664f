"""The API of ``launch_pytest``.

Launches are pytest fixtures. Tests run during a launch and after it.
"""
