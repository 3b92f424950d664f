"""Networks of our own: taught with labelled pictures, judged, exported with a card. Only the teaching needs PyTorch."""
