import { h } from "../../dom";
import type { TopicRow } from "../../protocol";
import type { TopicsState } from "../../state/monitor/topics";
import { strings } from "../../strings";
import { createTextField, createTickBox } from "../../widgets/controls";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { TopicLine } from "./topic-row";

/** The topics as in rqt_topic: rates of ticked topics, and the last message of open ones. */
export class TopicsPanel implements Panel {
  readonly id = "topics";
  readonly icon = "topics";
  readonly element: HTMLElement;
  private readonly tableBody = h("tbody");
  private readonly emptyNote = h("p", { class: "empty" }, strings.monitor.topics.none);
  private readonly lines = new Map<string, TopicLine>();
  private readonly measuredTopics = new Set<string>();
  private readonly unfoldedTopics = new Set<string>();
  private filter = "";
  private showsHidden = false;

  constructor(
    private readonly state: TopicsState,
    private readonly onPlotField: (topic: string, path: string) => void,
    private readonly showInScene: (topic: string) => void,
  ) {
    const texts = strings.monitor.topics;
    const filter = createTextField(strings.monitor.filter, (text) => {
      this.filter = text.trim().toLowerCase();
      this.show();
    });
    const hiddenBox = createTickBox(texts.hidden, texts.hiddenHint, (isTicked) => {
      this.showsHidden = isTicked;
      this.show();
    });
    const toolbar = h("div", { class: "toolbar" }, filter, h("span", { class: "spacer" }), hiddenBox);
    const createHeading = (text: string, hint = text, isNumeric = true): HTMLElement =>
      h("th", { class: isNumeric ? "numeric" : "", title: hint }, text);
    const table = h(
      "table",
      { class: "topic-table" },
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          createHeading(texts.name, texts.measureHint, false),
          createHeading(texts.type, texts.type, false),
          createHeading(texts.publishers, texts.publishersHint),
          createHeading(texts.subscribers, texts.subscribersHint),
          createHeading(texts.rate),
          createHeading(texts.bandwidth),
        ),
      ),
      this.tableBody,
    );
    this.element = h("div", { class: "panel monitor" }, toolbar, h("div", { class: "scroll" }, table, this.emptyNote));
    this.element.addEventListener("keydown", (event) => this.onKeyDown(event));
    state.listChanged.on(() => this.show());
    state.figuresChanged.on(() => this.showTraffic());
    state.messageArrived.on((message) => this.lines.get(message.topic)?.showMessage(message));
    onVisibilityChange(this.element, (isVisible) => {
      state.watchList(this, isVisible);
      state.watch(isVisible ? this.measuredTopics : [], isVisible ? this.unfoldedTopics : []);
    });
  }

  private show(): void {
    const shownTopics = this.state.topics.filter((topic) => this.isShown(topic));
    const rows = shownTopics.flatMap((topic) => {
      const line = this.findOrCreateLine(topic.name);
      line.show(topic);
      line.setState(this.measuredTopics.has(topic.name), this.unfoldedTopics.has(topic.name));
      return [line.mainRow, line.messageRow];
    });
    const isUnchanged = rows.length === this.tableBody.childElementCount && rows.every((row, index) => row === this.tableBody.children[index]);
    if (!isUnchanged) this.tableBody.replaceChildren(...rows);
    this.emptyNote.hidden = rows.length > 0;
  }

  private isShown({ name }: TopicRow): boolean {
    if (!name.toLowerCase().includes(this.filter)) return false;
    return this.showsHidden || !name.split("/").some((part) => part.startsWith("_"));
  }

  private findOrCreateLine(name: string): TopicLine {
    const existing = this.lines.get(name);
    if (existing) return existing;
    const line = new TopicLine(name, {
      onMeasured: (topic, isTicked) => {
        setMember(this.measuredTopics, topic, isTicked);
        if (!isTicked) this.unfoldedTopics.delete(topic);
        this.watch();
      },
      onOpened: (topic, isOpen) => {
        setMember(this.unfoldedTopics, topic, isOpen);
        this.watch();
      },
      onPlotted: (topic, path) => this.onPlotField(topic, path),
      onShown: (topic) => this.showInScene(topic),
    });
    this.lines.set(name, line);
    return line;
  }

  private watch(): void {
    this.state.watch(this.measuredTopics, this.unfoldedTopics);
    this.show();
  }

  private showTraffic(): void {
    for (const [name, line] of this.lines) line.showTraffic(this.state.traffic.get(name));
  }

  /** Moves to the previous or next topic with the arrow keys. */
  private onKeyDown(event: KeyboardEvent): void {
    if (event.key !== "ArrowDown" && event.key !== "ArrowUp") return;
    const expanders = [...this.tableBody.querySelectorAll<HTMLElement>(":scope > tr[data-topic] .expander")];
    const index = expanders.indexOf(document.activeElement as HTMLElement);
    if (index < 0) return;
    expanders[index + (event.key === "ArrowDown" ? 1 : -1)]?.focus();
    event.preventDefault();
  }
}

function setMember(set: Set<string>, member: string, isMember: boolean): void {
  if (isMember) set.add(member);
  else set.delete(member);
}
