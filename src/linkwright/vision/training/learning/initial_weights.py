"""Initial weights from a network that `linkwright vision train` exported.

The export folds the normalization into each convolution. This module splits it into two layers with the same result.
The file lacks the statistics of the normalization, so they are measured with images.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import onnx
import torch
from onnx import numpy_helper
from torch import Tensor, nn

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, display_path, foreign, missing_file_hint, phrase
from linkwright.vision.detectors.class_names import parse_metadata_names
from linkwright.vision.training.learning.network import Convolution, Network

_MIN_NORM = 1e-12  # the minimum norm of a kernel, which avoids a division by zero


def load_weights(network: Network, names: Sequence[str], path: Path, images: Iterable[Tensor]) -> None:
    """Load the weights of an ONNX file into a network.

    Classes are matched by name. The weights for a class that is not in the file stay unchanged.

    Args:
        network: the network to change. If its classes are those of the file, it computes the same boxes and logits,
            up to the shift that the export adds. It is in evaluation mode afterwards.
        names: the names of the network's classes.
        path: the path of the ONNX file.
        images: the images with which layer statistics are measured, shape (batch, 3, height, width).

    Raises:
        LinkwrightError: VISION308, the file cannot be read, or contains a different network.
    """
    file_names, weights = _read_onnx_file(path)
    convolutions = _find_execution_order(network.eval())
    channels, expected = len(weights[0][0]), network.shape.channels
    if len(weights) == len(convolutions) and channels != expected:
        reason = phrase(
            "its first layer has {channels} channels, but this network has {expected}",
            channels=channels,
            expected=expected,
        )
        raise _weights_error(path, reason, phrase("train with `--channels {channels}`", channels=channels))
    scores = [head.scores[-1] for head in network.heads]
    shapes = [
        (len(file_names) if layer in scores else len(layer.weight), *layer.weight.shape[1:]) for layer in convolutions
    ]
    if shapes != [tuple(kernel.shape) for kernel, _ in weights]:
        raise _weights_error(path, phrase("`linkwright vision train` did not create it"))
    blocks = {block.convolution: block for block in network.modules() if isinstance(block, Convolution)}
    with torch.no_grad():
        for layer, (kernel, bias) in zip(convolutions, weights, strict=True):
            if layer in scores:
                for row, name in enumerate(names):
                    if name in file_names:
                        layer.weight[row], layer.bias[row] = (
                            kernel[file_names.index(name)],
                            bias[file_names.index(name)],
                        )
            else:
                layer.weight.copy_(kernel)
                _set_bias(blocks[layer].norm if layer in blocks else layer, bias)
        _restore_normalization(network, list(blocks.values()), images)


def _read_onnx_file(path: Path) -> tuple[tuple[str, ...], list[tuple[Tensor, Tensor]]]:
    """Return the class names, and the kernel and bias of each convolution in execution order."""
    try:
        model = onnx.load(path, load_external_data=False)
        tensors = {tensor.name: numpy_helper.to_array(tensor) for tensor in model.graph.initializer}
    except FileNotFoundError:
        raise _weights_error(path, phrase("it does not exist"), missing_file_hint(path)) from None
    except OSError as error:
        raise _weights_error(path, foreign(error.strerror or error)) from None
    except Exception:  # noqa: BLE001 - protobuf and ONNX raise many kinds
        raise _weights_error(path, phrase("it is not an ONNX file")) from None
    casts = (step for step in model.graph.node if step.op_type == "Cast" and step.input[:1])
    tensors.update({cast.output[0]: tensors[cast.input[0]] for cast in casts if cast.input[0] in tensors})
    metadata = {entry.key: entry.value for entry in model.metadata_props}
    names = parse_metadata_names(metadata.get("names", ""))
    inputs = [step.input[1:] for step in model.graph.node if step.op_type == "Conv"]
    if (
        names is None
        or not inputs
        or not all(len(input_names) == 2 and set(input_names) <= tensors.keys() for input_names in inputs)
    ):
        raise _weights_error(path, phrase("`linkwright vision train` did not create it"))
    weights = [(torch.tensor(tensors[kernel]).float(), torch.tensor(tensors[bias]).float()) for kernel, bias in inputs]
    return names, weights


def _find_execution_order(network: Network) -> list[nn.Conv2d]:
    """Return the convolutions of a network in execution order."""
    ordered: list[nn.Conv2d] = []
    layers = [module for module in network.modules() if isinstance(module, nn.Conv2d)]
    hooks = [module.register_forward_hook(lambda layer, _, __: ordered.append(layer)) for module in layers]
    with torch.no_grad():
        network(torch.zeros(1, 3, 32, 32, device=layers[0].weight.device))
    for hook in hooks:
        hook.remove()
    return ordered


def _set_bias(layer: nn.Conv2d | nn.BatchNorm2d, bias: Tensor) -> None:
    """Set the bias of a layer, and turn a normalization into the addition of this bias."""
    layer.bias.copy_(bias)
    if isinstance(layer, nn.BatchNorm2d):
        layer.weight.fill_(1.0)
        layer.running_mean.zero_()
        layer.running_var.fill_(1.0 - layer.eps)


def _restore_normalization(network: Network, blocks: Sequence[Convolution], images: Iterable[Tensor]) -> None:
    """Move scale and statistics from the kernels into the normalizations.

    The results stay the same. Then each output's kernel has norm 1, which the optimizer needs because all its steps
    have the same length.
    """
    sums = {block.norm: torch.zeros(3, block.norm.num_features, dtype=torch.float64) for block in blocks}

    def measure(layer: nn.BatchNorm2d, inputs: tuple[Tensor]) -> None:
        values = inputs[0].double().transpose(0, 1).flatten(1).cpu()
        sums[layer] += torch.stack((torch.full((len(values),), values.shape[1]), values.sum(1), (values**2).sum(1)))

    hooks = [block.norm.register_forward_pre_hook(measure) for block in blocks]
    for image in images:
        network(image)
    for hook in hooks:
        hook.remove()
    for block in blocks:
        kernel, norm = block.convolution.weight, block.norm
        norms = kernel.flatten(1).norm(dim=1).clamp_min(_MIN_NORM)
        count, total, squares = sums[norm]
        mean = total / count
        variance = (squares / count - mean**2).clamp_min(0.0)
        mean, variance = mean.to(kernel), variance.to(kernel)
        kernel.div_(norms[:, None, None, None])
        norm.running_mean.copy_(mean / norms)
        norm.running_var.copy_(variance / norms**2)
        norm.weight.copy_((variance + norm.eps * norms**2).sqrt())
        norm.bias.add_(mean)


def _weights_error(path: Path, reason: Phrase, hint: Phrase | None = None) -> LinkwrightError:
    message = phrase("cannot start from the weights of '{path}': {reason}", path=display_path(path), reason=reason)
    return LinkwrightError(Diagnostic("VISION308", message, hint=hint))
