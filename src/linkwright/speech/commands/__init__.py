"""From words to what a robot is to do: phrases with numbers and units, and the file that says what they mean."""
