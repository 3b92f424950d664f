"""The code that imports PyTorch.

Call `linkwright.vision.training.library.require_pytorch` before importing it.
"""
