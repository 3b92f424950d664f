"""MoveIt's MotionPlanning display and panel: goals are set in the page, and move_group plans."""
