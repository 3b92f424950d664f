import { createButton, coalesce, h } from "../../dom";
import { createIcon } from "../../icons";
import type { LogLine } from "../../protocol";
import { formatClock } from "../../state/monitor/figure-text";
import { LEVELS, levelOf, formatLine, type LogState } from "../../state/monitor/log";
import { strings } from "../../strings";
import { createTextField } from "../../widgets/controls";
import { copyText } from "../../widgets/copy-text";
import { FollowingList } from "../../widgets/following-list";
import type { Panel } from "../panel";

const ROW_HEIGHT_PX = 21;

/** The records of /rosout, as rqt_console shows them. */
export class LogPanel implements Panel {
  readonly id = "log";
  readonly icon = "log";
  readonly element: HTMLElement;
  private readonly list: FollowingList<LogLine>;
  private readonly nodeSelect = h("select", { class: "choice", title: strings.monitor.log.node, aria: { label: strings.monitor.log.node } });
  private readonly pauseButton: HTMLButtonElement;
  private readonly newestButton: HTMLButtonElement;
  private readonly countNote = h("span", { class: "note" });
  private readonly details = h("div", { class: "log-details" });
  private chosenLine: LogLine | null = null;
  private shownNodesKey: string | null = null;

  constructor(private readonly state: LogState) {
    const texts = strings.monitor.log;
    this.list = new FollowingList<LogLine>(ROW_HEIGHT_PX, (line) => this.createRow(line), () => this.updateNewestButton());
    this.list.element.setAttribute("role", "region");
    this.list.element.setAttribute("aria-label", texts.list);
    this.list.element.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.pauseButton = createButton(texts.pauseHint, () => state.setPaused(!state.isPaused), "tool", strings.monitor.pause);
    this.newestButton = createButton(texts.newestHint, () => this.list.follow(), "tool", createIcon("follow"), texts.newest);
    const copyButton = createButton(texts.copyHint, () => this.copy(copyButton), "tool", createIcon("copy"), texts.copy);
    this.nodeSelect.addEventListener("change", () => state.setNode(this.nodeSelect.value));
    const filters = h(
      "div",
      { class: "toolbar" },
      this.createLevels(),
      this.nodeSelect,
      createTextField(strings.monitor.filter, (text) => state.setText(text)),
      h("span", { class: "spacer" }),
      this.countNote,
    );
    const toolbar = h(
      "div",
      { class: "toolbar" },
      this.pauseButton,
      createButton(texts.clearHint, () => state.clear(), "tool", createIcon("clear"), strings.monitor.clear),
      copyButton,
      h("span", { class: "spacer" }),
      this.newestButton,
    );
    const header = h("div", { class: "log-row log-head" });
    for (const text of [texts.level, texts.time, texts.node, texts.message, texts.location]) header.append(h("span", {}, text));
    this.details.hidden = true;
    this.element = h("div", { class: "panel monitor log" }, toolbar, filters, header, this.list.element, this.details);
    state.changed.on(coalesce(() => this.show()));
    this.show();
    this.updateNewestButton();
  }

  onOpened(): void {
    this.state.setOpen(true);
  }

  onClosed(): void {
    this.state.setOpen(false);
  }

  private createLevels(): HTMLElement {
    const group = h("div", { class: "segmented", role: "group", aria: { label: strings.monitor.log.level } });
    for (const level of LEVELS) {
      const name = strings.monitor.log.levels[level];
      const toggle = createButton(
        name,
        () => {
          this.state.setLevel(level, !this.state.levels.has(level));
          updateToggle();
        },
        `log-level-${level}`,
        name,
      );
      const updateToggle = (): void => {
        const isOn = this.state.levels.has(level);
        toggle.classList.toggle("on", isOn);
        toggle.setAttribute("aria-pressed", String(isOn));
      };
      updateToggle();
      group.append(toggle);
    }
    return group;
  }

  private show(): void {
    const texts = strings.monitor.log;
    const { lines, shownLines, missedCount, isPaused } = this.state;
    this.list.show(shownLines);
    const countText = texts.shown(shownLines.length, lines.length);
    this.countNote.textContent = missedCount > 0 ? `${countText}, ${texts.missed(missedCount)}` : countText;
    this.pauseButton.replaceChildren(createIcon(isPaused ? "play" : "pause"), isPaused ? strings.monitor.resume : strings.monitor.pause);
    this.pauseButton.classList.toggle("on", isPaused);
    const { nodes } = this.state;
    if (nodes.join("\n") === this.shownNodesKey) return;
    this.shownNodesKey = nodes.join("\n");
    const chosenNode = this.nodeSelect.value;
    this.nodeSelect.replaceChildren(new Option(texts.allNodes, ""), ...nodes.map((name) => new Option(name)));
    this.nodeSelect.value = nodes.includes(chosenNode) ? chosenNode : "";
  }

  private updateNewestButton(): void {
    this.newestButton.classList.toggle("on", this.list.isFollowing);
    this.newestButton.setAttribute("aria-pressed", String(this.list.isFollowing));
  }

  private createRow(line: LogLine): HTMLElement {
    const level = levelOf(line);
    const row = h(
      "div",
      { class: `log-row log-level-${level}`, title: line.message },
      h("span", { class: "log-level" }, strings.monitor.log.names[level]),
      h("span", { class: "note" }, formatClock(line.time)),
      h("span", {}, line.node),
      h("span", { class: "log-message" }, line.message),
      h("span", { class: "note" }, formatLocation(line)),
    );
    row.classList.toggle("chosen", line === this.chosenLine);
    row.addEventListener("click", () => this.chooseLine(line === this.chosenLine ? null : line));
    return row;
  }

  /** Moves to the previous or next record with the arrow keys. */
  private onKeyDown(event: KeyboardEvent): void {
    const { shownLines } = this.state;
    const index = this.chosenLine ? shownLines.indexOf(this.chosenLine) : shownLines.length;
    if (event.key === "ArrowUp") this.chooseLine(shownLines[Math.max(0, index - 1)] ?? null);
    else if (event.key === "ArrowDown") this.chooseLine(shownLines[Math.min(shownLines.length - 1, index + 1)] ?? null);
    else if (event.key === "Escape") this.chooseLine(null);
    else if (event.key === "End") this.list.follow();
    else return;
    event.preventDefault();
    const row = this.list.element.querySelector(".chosen");
    row?.scrollIntoView({ block: "nearest" });
  }

  /** Shows a record in full below the list. */
  private chooseLine(line: LogLine | null): void {
    this.chosenLine = line;
    this.list.show(this.state.shownLines);
    this.details.hidden = line === null;
    if (!line) return;
    const source = line.file === "" ? "" : `${line.file}:${line.line} ${line.function}`;
    this.details.replaceChildren(h("pre", {}, line.message), h("div", { class: "note" }, source));
  }

  private copy(button: HTMLButtonElement): void {
    const text = this.state.shownLines.map((line) => formatLine(line, strings.monitor.log.names[levelOf(line)])).join("\n");
    void copyText(text).then((isCopied) => {
      button.classList.toggle("done", isCopied);
      button.title = isCopied ? strings.monitor.log.copied : strings.monitor.log.copyHint;
    });
  }
}

function formatLocation({ file, line }: LogLine): string {
  return file === "" ? "" : `${file.split("/").at(-1) ?? ""}:${line}`;
}
