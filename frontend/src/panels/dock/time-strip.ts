import type { DockviewApi, DockviewGroupPanel } from "dockview";
import { TIME_HEIGHT } from "./default-layout";

/** What the dock gives any group. */
const LEAST_HEIGHT = 100;

/** Keeps the Time panel a strip of one line, without a tab, as long as it is alone in its place. */
export class TimeStrip {
  private strip: DockviewGroupPanel | null = null;

  constructor(private readonly api: DockviewApi) {}

  /** The arrangement may be another. */
  follow(): void {
    const group = this.api.getPanel("time")?.group;
    const strip = group?.panels.length === 1 ? group : null;
    if (strip === this.strip) return;
    // What became a place of several tabs has a bar for them, and room.
    if (this.strip && this.api.groups.includes(this.strip)) {
      this.strip.header.hidden = false;
      this.strip.element.classList.remove("strip");
      this.strip.api.setConstraints({ minimumHeight: LEAST_HEIGHT, maximumHeight: Number.MAX_SAFE_INTEGER });
    }
    this.strip = strip;
    if (!strip) return;
    strip.header.hidden = true;
    strip.element.classList.add("strip");
    strip.api.setConstraints({ minimumHeight: TIME_HEIGHT, maximumHeight: TIME_HEIGHT });
    strip.api.setSize({ height: TIME_HEIGHT });
  }
}
