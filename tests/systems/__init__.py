"""Other systems, as far as tests on this one can check them: system-specific modules, and a limited Python."""
