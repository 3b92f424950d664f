import { createButton, coalesce, h } from "../../dom";
import { createIcon } from "../../icons";
import type { HistoryExtent } from "../../protocol";
import { LETTER_INPUT_SELECTOR } from "../../scene/keyboard";
import type { RecordingControl } from "../../state/recording";
import type { Session } from "../../state/session";
import { SPEEDS, type TimelineState } from "../../state/timeline";
import { strings } from "../../strings";
import { RecordButton } from "./record-button";
import { formatAge, formatClock, computeDensities, formatExtent, formatMoment, formatElapsed } from "./timeline-text";

/** The share of its memory limit from which the history counts as full. */
const FULL_SHARE = 0.9;

/** Returns the tooltip of the history, with the way to extend it if its memory is full. */
function formatExtentTip(extent: HistoryExtent): string {
  const text = strings.timeline.kept(formatExtent(extent), (extent.max_size / 1e6).toFixed(0));
  return extent.size < FULL_SHARE * extent.max_size ? text : `${text}\n${strings.timeline.more}`;
}

/** The share of the timeline by which Page Up and Page Down move. */
const PAGE_SHARE = 0.1;

/**
 * The bar in the footer of the page while a recording or the history is shown: play, step, speed, loop, and a track to
 * drag on. Otherwise it has only the record button.
 */
export class TimelineBar {
  readonly element: HTMLElement;
  private readonly playButton: HTMLButtonElement;
  private readonly loopButton: HTMLButtonElement;
  private readonly speedSelect = h("select", { class: "choice", title: strings.timeline.speed, aria: { label: strings.timeline.speed } });
  private readonly stepSelect = h("select", { class: "choice timeline-steps", title: strings.timeline.steps, aria: { label: strings.timeline.steps } });
  /** Whether the focused element was focused with the pointer, not with Tab. */
  private isFocusedByPress = false;
  private readonly timeOutput = h("output", { class: "timeline-time" });
  private readonly densityCanvas = h("canvas", { class: "timeline-marks" });
  private readonly playhead = h("div", { class: "timeline-head" });
  private readonly markedPart = h("div", { class: "timeline-part" });
  /** The time at which the user started to mark a part, s since the epoch; null while no part is being marked. */
  private markStart: number | null = null;
  private readonly track: HTMLElement;
  private readonly liveButton: HTMLButtonElement;
  private readonly backButton: HTMLButtonElement;
  private readonly forwardButton: HTMLButtonElement;
  private readonly problem = h("span", { class: "timeline-problem", role: "alert" });

  private readonly timeline: TimelineState;
  private readonly recording: RecordingControl;

  constructor(session: Session) {
    const { timeline } = session;
    this.timeline = timeline;
    this.recording = session.recording;
    const texts = strings.timeline;
    this.playButton = createButton(texts.play, () => timeline.setPlaying(!timeline.isPlaying), "tool bare", createIcon("play"));
    this.loopButton = createButton(texts.loop, () => timeline.setLoop(!timeline.isLooping), "tool bare", createIcon("loop"));
    this.liveButton = createButton(texts.live, () => timeline.goLive(), "timeline-live");
    this.liveButton.textContent = texts.liveShort;
    this.backButton = createButton(texts.back, () => timeline.step(false), "tool bare", createIcon("stepBack"));
    this.forwardButton = createButton(texts.forward, () => timeline.step(true), "tool bare", createIcon("step"));
    this.speedSelect.append(...SPEEDS.map((speed) => new Option(`${speed}×`, String(speed))));
    this.speedSelect.addEventListener("change", () => timeline.setSpeed(Number(this.speedSelect.value)));
    this.stepSelect.addEventListener("change", () => (timeline.stepTopic = this.stepSelect.value));
    this.track = h("div", { class: "timeline-track", role: "slider", tabIndex: 0, aria: { label: texts.position } }, this.densityCanvas, this.markedPart, this.playhead);
    this.track.addEventListener("pointerdown", (event) => this.onPointerDown(event));
    this.track.addEventListener("pointermove", (event) => {
      if (!this.track.hasPointerCapture(event.pointerId)) return;
      if (this.markStart === null) this.seekTo(event);
      else timeline.setMark({ start: this.markStart, end: this.timeAt(event) });
    });
    this.track.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.element = h(
      "section",
      { class: "timeline-bar", aria: { label: texts.label } },
      this.backButton,
      this.playButton,
      this.forwardButton,
      this.stepSelect,
      this.track,
      this.problem,
      this.timeOutput,
      this.speedSelect,
      this.loopButton,
      new RecordButton(session).element,
      this.liveButton,
    );
    timeline.changed.on(() => this.show());
    session.recording.changed.on(() => this.updateVisibility());
    timeline.moved.on(coalesce(() => this.showPosition()));
    new ResizeObserver(() => this.drawDensities()).observe(this.track);
    this.bindKeys();
    this.bindSceneKeys();
    this.show();
  }

  private show(): void {
    const { timeline, isPlaying, speed, isLooping, problem } = this.timeline;
    const texts = strings.timeline;
    const isLiveHistory = timeline?.live ?? false;
    this.updateVisibility();
    this.element.classList.toggle("minutes", isLiveHistory);
    this.liveButton.hidden = !isLiveHistory;
    this.liveButton.setAttribute("aria-pressed", String(this.timeline.isLive));
    this.forwardButton.hidden = this.speedSelect.hidden = isLiveHistory && this.timeline.isLive;
    this.loopButton.hidden = isLiveHistory;
    this.track.setAttribute("aria-label", isLiveHistory ? texts.minutes : texts.position);
    this.updateStepSelect();
    const label = isPlaying ? texts.pause : texts.play;
    if (this.playButton.title !== label) {
      this.playButton.title = label;
      this.playButton.setAttribute("aria-label", label);
      this.playButton.replaceChildren(createIcon(isPlaying ? "pause" : "play"));
    }
    this.loopButton.setAttribute("aria-pressed", String(isLooping));
    this.loopButton.classList.toggle("on", isLooping);
    this.speedSelect.value = String(speed);
    this.problem.textContent = problem;
    this.problem.title = problem;
    this.drawDensities();
    this.showPosition();
  }

  /** Offers the topics to step by: those of the recording, or for live data those that are displayed. */
  private updateStepSelect(): void {
    const topics = (this.timeline.timeline?.topics ?? []).filter(({ count }) => count > 0).map(({ name }) => name);
    this.stepSelect.hidden = topics.length < 2;
    const options = [new Option(strings.timeline.allSteps, ""), ...topics.map((name) => new Option(name, name))];
    if (this.stepSelect.options.length !== options.length) this.stepSelect.replaceChildren(...options);
    this.stepSelect.value = this.timeline.stepTopic;
  }

  private updateVisibility(): void {
    const hasNoTimeline = this.timeline.timeline === null;
    this.element.hidden = hasNoTimeline && !this.recording.isPossible;
    this.element.classList.toggle("recorder-only", hasNoTimeline);
  }

  private showPosition(): void {
    const { timeline, position, isLive, extent } = this.timeline;
    if (!timeline) return;
    const { start, end } = timeline;
    const fraction = end > start ? Math.min(1, Math.max(0, (position - start) / (end - start))) : 1;
    this.playhead.style.left = `${(fraction * 100).toFixed(3)}%`;
    // The age cannot identify the displayed moment, because it keeps growing while time is paused.
    const timeText = extent ? (isLive ? formatExtent(extent) : formatMoment(position)) : formatElapsed(position - start, end - start);
    this.timeOutput.textContent = timeText;
    this.timeOutput.title = extent ? `${formatClock(position)}${isLive ? "" : ` ${formatAge(end - position)}`}\n${formatExtentTip(extent)}` : formatClock(position);
    this.showMark(start, end);
    this.track.setAttribute("aria-valuemin", "0");
    this.track.setAttribute("aria-valuemax", String(end - start));
    this.track.setAttribute("aria-valuenow", (position - start).toFixed(3));
    this.track.setAttribute("aria-valuetext", timeText);
  }

  private onPointerDown(event: PointerEvent): void {
    if (event.button !== 0) return;
    this.track.setPointerCapture(event.pointerId);
    this.markStart = event.shiftKey && this.timeline.timeline?.live === true ? this.timeAt(event) : null;
    if (this.markStart === null) this.seekTo(event);
    else this.timeline.setMark(null);
  }

  private seekTo(event: PointerEvent): void {
    this.timeline.seek(this.timeAt(event));
  }

  /** Returns the time at the pointer, s since the epoch. */
  private timeAt(event: PointerEvent): number {
    const { start, end } = this.timeline.timeline ?? { start: 0, end: 0 };
    const trackRect = this.track.getBoundingClientRect();
    return Math.min(end, Math.max(start, start + ((event.clientX - trackRect.left) / trackRect.width) * (end - start)));
  }

  private showMark(start: number, end: number): void {
    const { mark } = this.timeline;
    this.markedPart.hidden = mark === null;
    if (!mark || end <= start) return;
    this.markedPart.style.left = `${((100 * (mark.start - start)) / (end - start)).toFixed(3)}%`;
    this.markedPart.style.width = `${((100 * (mark.end - mark.start)) / (end - start)).toFixed(3)}%`;
  }

  private onKeyDown(event: KeyboardEvent): void {
    const { timeline, position } = this.timeline;
    if (!timeline || event.ctrlKey || event.metaKey || event.altKey) return;
    const pageLength = PAGE_SHARE * (timeline.end - timeline.start);
    const targetTimes: Record<string, number> = {
      Home: timeline.start,
      End: timeline.end,
      PageUp: position - pageLength,
      PageDown: position + pageLength,
    };
    const targetTime = targetTimes[event.key];
    if (targetTime === undefined) return;
    this.timeline.seek(targetTime);
    event.preventDefault();
  }

  /** Binds Space to play and pause, and the arrow keys to steps, unless the focused element uses these keys. */
  private bindKeys(): void {
    document.addEventListener("keydown", (event) => {
      const { target } = event;
      if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || !this.timeline.timeline) return;
      if (!(target instanceof Element) || target.closest(LETTER_INPUT_SELECTOR)) return;
      if (event.key === " " && !target.closest("button, input, summary, a")) this.timeline.setPlaying(!this.timeline.isPlaying);
      else if (event.key === "ArrowLeft" && this.canUseArrowKeys(target)) this.timeline.step(false);
      else if (event.key === "ArrowRight" && this.canUseArrowKeys(target)) this.timeline.step(true);
      else if (event.key === "[" && this.timeline.timeline.live) this.timeline.markHere("start");
      else if (event.key === "]" && this.timeline.timeline.live) this.timeline.markHere("end");
      else return;
      event.preventDefault();
    });
  }

  /** Binds the arrow keys to steps after a press on the scene at a past time; after Tab they rotate the camera. */
  private bindSceneKeys(): void {
    document.addEventListener("pointerdown", () => (this.isFocusedByPress = true), true);
    document.addEventListener(
      "keydown",
      (event) => {
        if (event.key === "Tab") this.isFocusedByPress = false;
        const isForward = event.key === "ArrowRight";
        if (!isForward && event.key !== "ArrowLeft") return;
        if (event.shiftKey || event.ctrlKey || event.metaKey || event.altKey || !this.isFocusedByPress) return;
        if (!(event.target instanceof HTMLCanvasElement) || !this.timeline.timeline || this.timeline.isLive) return;
        this.timeline.step(isForward);
        event.preventDefault();
        event.stopPropagation();
      },
      true,
    );
  }

  private canUseArrowKeys(target: Element): boolean {
    return target === document.body || this.element.contains(target);
  }

  /** Draws the density of messages, in one row for each topic with messages; darker means more messages. */
  private drawDensities(): void {
    const rows = computeDensities(this.timeline.timeline?.topics ?? []);
    const { width, height } = this.track.getBoundingClientRect();
    const scale = window.devicePixelRatio;
    this.densityCanvas.width = Math.max(1, Math.round(width * scale));
    this.densityCanvas.height = Math.max(1, Math.round(height * scale));
    const context = this.densityCanvas.getContext("2d");
    if (!context || rows.length === 0) return;
    context.fillStyle = getComputedStyle(this.track).getPropertyValue("--accent");
    const rowHeight = this.densityCanvas.height / rows.length;
    rows.forEach((row, rowIndex) => {
      const partWidth = this.densityCanvas.width / row.length;
      row.forEach((density, index) => {
        if (density === 0) return;
        context.globalAlpha = density;
        context.fillRect(index * partWidth, rowIndex * rowHeight, partWidth, Math.max(1, rowHeight - 1));
      });
    });
  }
}
