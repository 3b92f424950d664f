import type { PanelTab } from "./panel-tab";

const CLOSE = ["Delete", "Backspace"];

/**
 * Closes panels with Delete on their tabs; the next tab has the focus then.
 *
 * The dock has keys for that itself, which would take away panels that must stay.
 */
export function takeTabKeys(dock: HTMLElement, tabOf: (panel: string) => PanelTab | undefined): void {
  dock.addEventListener(
    "keydown",
    (event) => {
      const tab = event.target;
      if (!(tab instanceof HTMLElement) || tab.role !== "tab" || !CLOSE.includes(event.key)) return;
      const panel = tab.dataset["tabPanelId"];
      if (panel === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      const next = tab.nextElementSibling ?? tab.previousElementSibling;
      if (tabOf(panel)?.close() === true && next instanceof HTMLElement) next.focus();
    },
    true,
  );
}
