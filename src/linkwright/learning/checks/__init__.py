"""The checks of lessons: their declaration, the objects that they inspect, and their runs."""
