import type { DockviewApi } from "dockview";

/** Keeps the whole tab of each panel that is in front in view, where the tabs of its place need more room than there is. */
export class FrontTabs {
  private readonly sizes = new ResizeObserver(() => this.show());

  constructor(private readonly api: DockviewApi) {}

  /** The arrangement, or what is in front, may be another. */
  follow(): void {
    this.sizes.disconnect();
    // What the dock offers in place of the tabs that have no room comes later, and takes some.
    for (const bar of this.bars()) this.sizes.observe(bar);
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
