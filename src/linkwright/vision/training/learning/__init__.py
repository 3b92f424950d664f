"""What needs PyTorch; imported only after `linkwright.vision.training.library` has found it."""
