/** Calls `changed` whenever an element comes into sight or goes out of it: a panel behind another is out of sight. */
function watchVisibility(element: HTMLElement, changed: (visible: boolean) => void): void {
  let before = false;
  new IntersectionObserver((entries) => {
    const visible = entries.at(-1)?.isIntersecting ?? false;
    if (visible !== before) changed(visible);
    before = visible;
  }).observe(element);
}

/** Holds something for as long as an element is in sight. */
export function holdWhileVisible(element: HTMLElement, hold: () => () => void, shown: () => void): void {
  let release: (() => void) | null = null;
  watchVisibility(element, (visible) => {
    release?.();
    release = visible ? hold() : null;
    if (visible) shown();
  });
}
