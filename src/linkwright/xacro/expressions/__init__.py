"""The language of ``${...}`` and ``$(...)``: parser, compiler, and sandbox for evaluation."""
