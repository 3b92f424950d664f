import { h } from "../../dom";
import { computeMeterShare } from "../../state/voice/level";
import { strings } from "../../strings";

/** Sound clips at this peak and above. */
const CLIPPING_PEAK = 0.97;

/** A meter of the microphone's level. */
export class LevelMeter {
  readonly element: HTMLElement;
  private readonly bar = h("div", { class: "level-bar" });

  constructor(label: string) {
    this.element = h("div", { class: "level-meter", role: "meter", title: label, aria: { label, valuemin: "0", valuemax: "100" } }, this.bar);
    this.show(null);
  }

  /** Shows a peak from 0 to 1; null while there is no microphone. */
  show(peak: number | null): void {
    const fraction = computeMeterShare(peak ?? 0);
    this.bar.style.width = `${Math.round(100 * fraction)}%`;
    this.bar.classList.toggle("clipped", (peak ?? 0) >= CLIPPING_PEAK);
    this.element.setAttribute("aria-valuenow", String(Math.round(100 * fraction)));
    this.element.setAttribute("aria-valuetext", peak === null ? strings.voice.levelOff : `${Math.round(100 * fraction)} %`);
  }
}
