"""tf2: transforms over time, who sends them and who asks for them."""
