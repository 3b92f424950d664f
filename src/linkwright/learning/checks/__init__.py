"""The checks of lessons: declaring them, what they look at, and running them."""
