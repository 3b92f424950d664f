"""Compare the C++ headers that other packages include."""
