"""Hardware as controllers see it: interfaces, and what a description says of them."""
