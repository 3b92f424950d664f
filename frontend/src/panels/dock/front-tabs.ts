import type { DockviewApi } from "dockview";

/** Keeps the tab of each front panel fully visible where a group's tabs do not fit into its bar. */
export class FrontTabs {
  private readonly resizeObserver = new ResizeObserver(() => this.show());

  constructor(private readonly api: DockviewApi) {}

  /** Scrolls the tab bars after the arrangement or the front panels may have changed. */
  update(): void {
    this.resizeObserver.disconnect();
    // The dock's button for hidden tabs appears later and takes some of the bar's width.
    for (const bar of this.bars()) this.resizeObserver.observe(bar);
    this.show();
  }

  private show(): void {
    for (const bar of this.bars()) {
      const tab = bar.querySelector(".dv-active-tab");
      if (!tab) continue;
      const [all, own] = [bar.getBoundingClientRect(), tab.getBoundingClientRect()];
      if (own.left < all.left) bar.scrollLeft -= all.left - own.left;
      else if (own.right > all.right) bar.scrollLeft += Math.ceil(own.right - all.right);
    }
  }

  private bars(): Element[] {
    return this.api.groups.flatMap(({ element }) => element.querySelector(".dv-tabs-container") ?? []);
  }
}
