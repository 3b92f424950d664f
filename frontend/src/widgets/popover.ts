/** Pixels; a press that moves further is a drag, which rotates the scene and closes nothing. */
const CLICK_REACH = 5;

/**
 * Calls `close` on Escape, wherever the focus is, and on a click outside all of `inside`, until the returned function
 * is called. `back` is whether the focus should return to the element that opened the popover.
 */
export function closeOutside(inside: readonly Element[], close: (back: boolean) => void): () => void {
  let pressed: { x: number; y: number } | null = null;
  const isInside = ({ target }: Event): boolean => target instanceof Node && inside.some((each) => each.contains(target));
  const press = (event: PointerEvent): void => {
    pressed = isInside(event) ? null : { x: event.clientX, y: event.clientY };
  };
  const release = (event: PointerEvent): void => {
    const from = pressed;
    pressed = null;
    if (from && Math.hypot(event.clientX - from.x, event.clientY - from.y) < CLICK_REACH) close(false);
  };
  const onKeyDown = (event: KeyboardEvent): void => {
    // A menu or dialog over it closes first.
    if (event.key !== "Escape" || (event.target instanceof Element && event.target.closest("dialog, [role=menu], [role=listbox]"))) return;
    event.preventDefault();
    event.stopPropagation();
    close(event.target === document.body || isInside(event));
  };
  document.addEventListener("pointerdown", press, true);
  document.addEventListener("pointerup", release, true);
  document.addEventListener("keydown", onKeyDown, true);
  return () => {
    document.removeEventListener("pointerdown", press, true);
    document.removeEventListener("pointerup", release, true);
    document.removeEventListener("keydown", onKeyDown, true);
  };
}
