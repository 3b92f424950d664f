import type { DockviewApi } from "dockview";

/** Keeps the tab of each front panel fully visible where a group's tabs do not fit into its bar. */
export class FrontTabs {
  private readonly resizeObserver = new ResizeObserver(() => this.show());

  constructor(private readonly api: DockviewApi) {}

  /** Scrolls the tab bars after the arrangement or the front panels may have changed. */
  update(): void {
    this.resizeObserver.disconnect();
    // The dock's button for hidden tabs appears later and takes some of the bar's width.
    for (const bar of this.listTabBars()) this.resizeObserver.observe(bar);
    this.show();
  }

  private show(): void {
    for (const bar of this.listTabBars()) {
      const tab = bar.querySelector(".dv-active-tab");
      if (!tab) continue;
      const [barBox, tabBox] = [bar.getBoundingClientRect(), tab.getBoundingClientRect()];
      if (tabBox.left < barBox.left) bar.scrollLeft -= barBox.left - tabBox.left;
      else if (tabBox.right > barBox.right) bar.scrollLeft += Math.ceil(tabBox.right - barBox.right);
    }
  }

  private listTabBars(): Element[] {
    return this.api.groups.flatMap(({ element }) => element.querySelector(".dv-tabs-container") ?? []);
  }
}
