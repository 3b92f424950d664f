import type { PanelTab } from "./panel-tab";

const CLOSE_KEYS = ["Delete", "Backspace"];

/**
 * Binds Delete on a tab to closing its panel; the focus then moves to the next tab.
 *
 * The dock's own keys would also close panels that must stay.
 */
export function bindTabKeys(dock: HTMLElement, tabOf: (panel: string) => PanelTab | undefined): void {
  dock.addEventListener(
    "keydown",
    (event) => {
      const tab = event.target;
      if (!(tab instanceof HTMLElement) || tab.role !== "tab" || !CLOSE_KEYS.includes(event.key)) return;
      const panel = tab.dataset["tabPanelId"];
      if (panel === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      const neighborTab = tab.nextElementSibling ?? tab.previousElementSibling;
      if (tabOf(panel)?.close() === true && neighborTab instanceof HTMLElement) neighborTab.focus();
    },
    true,
  );
}
