import type { DockviewApi, DockviewGroupPanel } from "dockview";
import { Signal } from "../../signal";
import type { TextStorage } from "../../storage";
import { TIME_HEIGHT } from "./default-layout";

/** What the dock gives any group. */
const LEAST_HEIGHT = 100;
const KEY = "linkwright.time-fields";

/**
 * Keeps the Time panel a strip of one line, without a tab, as long as it is alone in its place; nothing of it is seen
 * before the user unfolds it.
 */
export class TimeStrip {
  /** It came, went, or was folded. */
  readonly changed = new Signal();
  private strip: DockviewGroupPanel | null = null;
  private unfolded: boolean;

  constructor(
    private readonly api: DockviewApi,
    private readonly storage: TextStorage,
  ) {
    this.unfolded = storage.getItem(KEY) === "shown";
  }

  /** Whether there is one, folded or not. */
  get isThere(): boolean {
    return this.strip !== null;
  }

  get isUnfolded(): boolean {
    return this.unfolded;
  }

  /** Shows its fields, or hides them. */
  unfold(unfolded: boolean): void {
    this.unfolded = unfolded;
    this.storage.setItem(KEY, unfolded ? "shown" : "hidden");
    this.show();
    this.changed.emit();
  }

  /** The arrangement may be another. */
  follow(): void {
    const group = this.api.getPanel("time")?.group;
    const strip = group?.panels.length === 1 ? group : null;
    if (strip === this.strip) return;
    // What became a place of several tabs has a bar for them, and room.
    if (this.strip && this.api.groups.includes(this.strip)) {
      this.strip.api.setVisible(true);
      this.strip.header.hidden = false;
      this.strip.element.classList.remove("strip");
      this.strip.api.setConstraints({ minimumHeight: LEAST_HEIGHT, maximumHeight: Number.MAX_SAFE_INTEGER });
    }
    this.strip = strip;
    if (strip) {
      strip.header.hidden = true;
      strip.element.classList.add("strip");
      strip.api.setConstraints({ minimumHeight: TIME_HEIGHT, maximumHeight: TIME_HEIGHT });
      this.show();
    }
    this.changed.emit();
  }

  private show(): void {
    const { strip } = this;
    if (!strip) return;
    if (strip.api.isVisible !== this.unfolded) strip.api.setVisible(this.unfolded);
    if (this.unfolded) strip.api.setSize({ height: TIME_HEIGHT });
  }
}
