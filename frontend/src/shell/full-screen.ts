/** Shows an element in full screen on F11, like RViz's full screen of the scene only; F11 or Esc ends it. */
export function bindFullScreenKey(element: HTMLElement): void {
  document.addEventListener("keydown", (event) => {
    if (event.key !== "F11" || !document.fullscreenEnabled) return;
    event.preventDefault();
    if (document.fullscreenElement) void document.exitFullscreen();
    else void element.requestFullscreen();
  });
}
