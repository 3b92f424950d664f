/** Calls `changed` when an element comes into sight or goes: a hidden tab of the dock takes its panel out of the page. */
export function whenSeen(element: HTMLElement, changed: (seen: boolean) => void): void {
  let seen = false;
  new ResizeObserver(() => {
    const now = element.isConnected && element.offsetWidth > 0;
    if (now === seen) return;
    seen = now;
    changed(seen);
  }).observe(element);
}
