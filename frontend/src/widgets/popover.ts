/** Pixels; a press that moves further is a drag, which rotates the scene and closes nothing. */
const MAX_CLICK_MOVE_PX = 5;

/**
 * Calls `close` on Escape, wherever the focus is, and on a click outside all `elements`, until the returned function is
 * called. `returnsFocus` is whether the focus should return to the element that opened the popover.
 */
export function closeOnOutsideClick(elements: readonly Element[], close: (returnsFocus: boolean) => void): () => void {
  let pressPoint: { x: number; y: number } | null = null;
  const isInside = ({ target }: Event): boolean => target instanceof Node && elements.some((element) => element.contains(target));
  const onPointerDown = (event: PointerEvent): void => {
    pressPoint = isInside(event) ? null : { x: event.clientX, y: event.clientY };
  };
  const onPointerUp = (event: PointerEvent): void => {
    const startPoint = pressPoint;
    pressPoint = null;
    if (startPoint && Math.hypot(event.clientX - startPoint.x, event.clientY - startPoint.y) < MAX_CLICK_MOVE_PX) close(false);
  };
  const onKeyDown = (event: KeyboardEvent): void => {
    // A menu or dialog over the popover closes first.
    if (event.key !== "Escape" || (event.target instanceof Element && event.target.closest("dialog, [role=menu], [role=listbox]"))) return;
    event.preventDefault();
    event.stopPropagation();
    close(event.target === document.body || isInside(event));
  };
  document.addEventListener("pointerdown", onPointerDown, true);
  document.addEventListener("pointerup", onPointerUp, true);
  document.addEventListener("keydown", onKeyDown, true);
  return () => {
    document.removeEventListener("pointerdown", onPointerDown, true);
    document.removeEventListener("pointerup", onPointerUp, true);
    document.removeEventListener("keydown", onKeyDown, true);
  };
}
