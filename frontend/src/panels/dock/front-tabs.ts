import type { DockviewApi } from "dockview";

/** Keeps the tab of each front panel fully visible where a group's tabs do not fit into its bar. */
export class FrontTabs {
  private readonly resizeObserver = new ResizeObserver(() => this.scrollToFrontTabs());

  constructor(private readonly api: DockviewApi) {}

  /** Scrolls the tab bars after the arrangement or the front panels may have changed. */
  update(): void {
    this.resizeObserver.disconnect();
    // The dock's button for hidden tabs appears later and takes some of the bar's width.
    for (const bar of this.listTabBars()) this.resizeObserver.observe(bar);
    this.scrollToFrontTabs();
  }

  private scrollToFrontTabs(): void {
    for (const bar of this.listTabBars()) {
      const tab = bar.querySelector(".dv-active-tab");
      if (!tab) continue;
      const [barRect, tabRect] = [bar.getBoundingClientRect(), tab.getBoundingClientRect()];
      if (tabRect.left < barRect.left) bar.scrollLeft -= barRect.left - tabRect.left;
      else if (tabRect.right > barRect.right) bar.scrollLeft += Math.ceil(tabRect.right - barRect.right);
    }
  }

  private listTabBars(): Element[] {
    return this.api.groups.flatMap(({ element }) => element.querySelector(".dv-tabs-container") ?? []);
  }
}
