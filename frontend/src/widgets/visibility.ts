/**
 * Calls `changed` when an element becomes visible or hidden; the dock removes the panels of hidden tabs from the page.
 */
export function onVisibilityChange(element: HTMLElement, changed: (seen: boolean) => void): void {
  let seen = false;
  new ResizeObserver(() => {
    const now = element.isConnected && element.offsetWidth > 0;
    if (now === seen) return;
    seen = now;
    changed(seen);
  }).observe(element);
}

/** Holds a resource while an element is visible; `shown` is called after each acquisition. */
export function holdWhileVisible(element: HTMLElement, hold: () => () => void, shown: () => void): void {
  let release: (() => void) | null = null;
  onVisibilityChange(element, (seen) => {
    release?.();
    release = seen ? hold() : null;
    if (seen) shown();
  });
}
