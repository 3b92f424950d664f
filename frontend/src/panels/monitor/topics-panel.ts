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
  private readonly body = h("tbody");
  private readonly empty = h("p", { class: "empty" }, strings.monitor.topics.none);
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
    const bar = h("div", { class: "toolbar" }, filter, h("span", { class: "spacer" }), hiddenBox);
    const createHead = (text: string, hint = text, isNumeric = true): HTMLElement =>
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
          createHead(texts.name, texts.measureHint, false),
          createHead(texts.type, texts.type, false),
          createHead(texts.publishers, texts.publishersHint),
          createHead(texts.subscribers, texts.subscribersHint),
          createHead(texts.rate),
          createHead(texts.bandwidth),
        ),
      ),
      this.body,
    );
    this.element = h("div", { class: "panel monitor" }, bar, h("div", { class: "scroll" }, table, this.empty));
    this.element.addEventListener("keydown", (event) => this.onKeyDown(event));
    state.listChanged.on(() => this.show());
    state.figuresChanged.on(() => this.showFigures());
    state.messageArrived.on((message) => this.lines.get(message.topic)?.showMessage(message));
    onVisibilityChange(this.element, (isVisible) => {
      state.watchList(this, isVisible);
      state.watch(isVisible ? this.measuredTopics : [], isVisible ? this.unfoldedTopics : []);
    });
  }

  private show(): void {
    const shownTopics = this.state.topics.filter((topic) => this.isShown(topic));
    const rows = shownTopics.flatMap((topic) => {
      const line = this.lineFor(topic.name);
      line.show(topic);
      line.setState(this.measuredTopics.has(topic.name), this.unfoldedTopics.has(topic.name));
      return [line.head, line.body];
    });
    const isUnchanged = rows.length === this.body.childElementCount && rows.every((row, index) => row === this.body.children[index]);
    if (!isUnchanged) this.body.replaceChildren(...rows);
    this.empty.hidden = rows.length > 0;
  }

  private isShown({ name }: TopicRow): boolean {
    if (!name.toLowerCase().includes(this.filter)) return false;
    return this.showsHidden || !name.split("/").some((part) => part.startsWith("_"));
  }

  private lineFor(name: string): TopicLine {
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

  private showFigures(): void {
    for (const [name, line] of this.lines) line.showTraffic(this.state.traffic.get(name));
  }

  /** Moves to the previous or next topic with the arrow keys. */
  private onKeyDown(event: KeyboardEvent): void {
    if (event.key !== "ArrowDown" && event.key !== "ArrowUp") return;
    const stops = [...this.body.querySelectorAll<HTMLElement>(":scope > tr[data-topic] .expander")];
    const index = stops.indexOf(document.activeElement as HTMLElement);
    if (index < 0) return;
    stops[index + (event.key === "ArrowDown" ? 1 : -1)]?.focus();
    event.preventDefault();
  }
}

function setMember(set: Set<string>, member: string, isMember: boolean): void {
  if (isMember) set.add(member);
  else set.delete(member);
}
