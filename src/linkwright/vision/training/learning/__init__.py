"""The part that imports PyTorch; imported only after `linkwright.vision.training.library` has found it."""
