/** A view of an image in a window: the position of the image's corner, px, and its scale. */
export interface ImageView {
  readonly x: number;
  readonly y: number;
  readonly scale: number;
}

type Size = readonly [width: number, height: number];

/** The minimum size of texts on the screen, px. */
const MIN_TEXT_PX = 10;

/**
 * Returns the view of a whole image if its texts are legible; otherwise of the part around a point, at the scale that
 * makes them legible.
 *
 * @param textSize - the size of the image's smallest text, px.
 * @param point - a point of the image, px, which is centered as far as the image's edges permit.
 */
export function computeLegibleView(image: Size, window: Size, textSize: number, point: readonly [number, number], margin = 16): ImageView {
  const fittingScale = Math.min((window[0] - 2 * margin) / image[0], (window[1] - 2 * margin) / image[1]);
  const scale = Math.min(1, Math.max(MIN_TEXT_PX / textSize, fittingScale));
  const choosePosition = (axis: 0 | 1): number => {
    const [size, available] = [image[axis] * scale, window[axis]];
    if (size <= available - 2 * margin) return (available - size) / 2;
    return Math.min(margin, Math.max(available - margin - size, available / 2 - point[axis] * scale));
  };
  return { x: choosePosition(0), y: choosePosition(1), scale };
}
