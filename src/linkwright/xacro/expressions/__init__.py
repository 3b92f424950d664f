"""The language of ``${...}`` and ``$(...)``: its reader, its compiler, and the sandbox for its evaluation."""
