"""MoveIt's Python library ``moveit_py``: plans in the program's own process, without move_group."""
