/**
 * Calls `onChanged` when an element becomes visible or hidden; the dock removes the panels of hidden tabs from the
 * page.
 */
export function onVisibilityChange(element: HTMLElement, onChanged: (isVisible: boolean) => void): void {
  let isVisible = false;
  new ResizeObserver(() => {
    const isVisibleNow = element.isConnected && element.offsetWidth > 0;
    if (isVisibleNow === isVisible) return;
    isVisible = isVisibleNow;
    onChanged(isVisible);
  }).observe(element);
}

/** Holds a resource while an element is visible; `onShown` is called after each acquisition. */
export function holdWhileVisible(element: HTMLElement, hold: () => () => void, onShown: () => void): void {
  let release: (() => void) | null = null;
  onVisibilityChange(element, (isVisible) => {
    release?.();
    release = isVisible ? hold() : null;
    if (isVisible) onShown();
  });
}
