/** F11 shows one element alone, as RViz's full screen shows only the scene; F11 or Esc ends it. */
export function fullScreenOnF11(element: HTMLElement): void {
  document.addEventListener("keydown", (event) => {
    if (event.key !== "F11" || !document.fullscreenEnabled) return;
    event.preventDefault();
    if (document.fullscreenElement) void document.exitFullscreen();
    else void element.requestFullscreen();
  });
}
