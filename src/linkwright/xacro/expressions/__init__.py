"""What stands in ``${...}`` and ``$(...)``: reading it, compiling it, and the sandbox that it is evaluated in."""
