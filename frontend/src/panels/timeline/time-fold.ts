import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { TimeControlState } from "../../state/time";
import { strings } from "../../strings";
import type { TimeStrip } from "../dock/time-strip";

/** The button in the footer that unfolds the fields of RViz's Time panel, and shows whether time is paused. */
export class TimeFold {
  readonly element: HTMLButtonElement;

  constructor(time: TimeControlState, strip: TimeStrip) {
    const stateText = h("span", {});
    this.element = createButton(strings.time.fold, () => strip.setUnfolded(!strip.isUnfolded), "tool bare time-fold", createIcon("clock"), stateText);
    this.element.setAttribute("aria-label", strings.panels.time);
    const show = (): void => {
      this.element.hidden = !strip.exists;
      this.element.setAttribute("aria-expanded", String(strip.isUnfolded));
      this.element.classList.toggle("active", time.isPaused);
      stateText.textContent = time.isPaused ? strings.time.paused : "";
    };
    strip.changed.on(show);
    time.changed.on(show);
    show();
  }
}
