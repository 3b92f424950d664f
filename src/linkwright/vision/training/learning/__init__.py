"""The code that imports PyTorch; import it only after `linkwright.vision.training.library` has found PyTorch."""
