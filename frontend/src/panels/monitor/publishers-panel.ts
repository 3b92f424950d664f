import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { PagePublisher, PublisherState } from "../../protocol";
import type { PublishersState } from "../../state/monitor/publishers";
import type { TopicsState } from "../../state/monitor/topics";
import { strings } from "../../strings";
import { createNumberField, createTickBox } from "../../widgets/controls";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { createSuggestions } from "./suggestions";

const MAX_RATE_HZ = 1000;

/** Publishes messages as rqt_publisher does: each publisher has a topic, a type, a rate, and a text in YAML. */
export class PublishersPanel implements Panel {
  readonly id = "publishers";
  readonly icon = "publishers";
  readonly element: HTMLElement;
  private readonly topic = h("input", { class: "field", aria: { label: strings.monitor.publishers.topic } });
  private readonly kind = h("input", { class: "field wide", aria: { label: strings.monitor.publishers.type } });
  private readonly list = h("div", { class: "scroll" });
  private readonly lines = new Map<number, PublisherLine>();
  private readonly topicNames = createSuggestions("linkwright-publisher-topics");
  private readonly types = createSuggestions("linkwright-publisher-types");

  constructor(
    private readonly state: PublishersState,
    topics: TopicsState,
  ) {
    const texts = strings.monitor.publishers;
    for (const [field, suggestions, label] of [[this.topic, this.topicNames, texts.topic], [this.kind, this.types, texts.type]] as const) {
      field.setAttribute("list", suggestions.element.id);
      field.placeholder = label;
      field.spellcheck = false;
    }
    this.topic.addEventListener("input", () => {
      const known = topics.topics.find(({ name }) => name === this.topic.value);
      if (known?.types[0] !== undefined) this.kind.value = known.types[0];
    });
    const form = h("form", { class: "toolbar" }, this.topic, this.kind, this.topicNames.element, this.types.element);
    const addButton = h("button", { class: "tool", title: texts.addHint }, createIcon("plus"), texts.add);
    form.append(addButton);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.add();
    });
    this.element = h("div", { class: "panel monitor" }, form, this.list);
    state.listChanged.on(() => this.show());
    state.statesChanged.on(() => this.showStates());
    state.typesArrived.on(() => this.types.show(state.types.map((type) => [type, ""])));
    topics.listChanged.on(() => this.topicNames.show(topics.topics.map(({ name, types }) => [name, types[0] ?? ""])));
    onVisibilityChange(this.element, (isVisible) => {
      if (isVisible) state.open();
      topics.watchList(this, isVisible);
    });
    this.show();
  }

  private add(): void {
    const [topic, kind] = [this.topic.value.trim(), this.kind.value.trim()];
    if (topic === "" || kind === "") return;
    this.state.add(topic.startsWith("/") ? topic : `/${topic}`, kind);
    this.topic.value = this.kind.value = "";
  }

  private show(): void {
    const { publishers } = this.state;
    for (const id of this.lines.keys()) if (!publishers.some((publisher) => publisher.id === id)) this.lines.delete(id);
    const elements = publishers.map((publisher) => {
      let line = this.lines.get(publisher.id);
      if (!line) this.lines.set(publisher.id, (line = new PublisherLine(publisher, this.state)));
      line.showText(publisher.text);
      return line.element;
    });
    this.list.replaceChildren(...(elements.length > 0 ? elements : [h("p", { class: "empty" }, strings.monitor.publishers.none)]));
    this.showStates();
  }

  private showStates(): void {
    for (const [id, line] of this.lines) line.showState(this.state.states.get(id));
  }
}

class PublisherLine {
  readonly element: HTMLElement;
  private readonly text = h("textarea", { class: "field message-text" });
  private readonly note = h("span", { class: "note", role: "status" });
  private readonly problem = h("div", { class: "wrong", role: "alert" });

  constructor({ id, topic, kind, rate, is_on }: PagePublisher, state: PublishersState) {
    const texts = strings.monitor.publishers;
    this.text.spellcheck = false;
    this.text.rows = 6;
    this.text.setAttribute("aria-label", texts.messageOf(topic));
    this.text.addEventListener("input", () => state.change(id, { text: this.text.value }));
    const onBox = createTickBox(topic, texts.onHint, (isOn) => state.change(id, { is_on: isOn }));
    onBox.box.checked = is_on;
    const rateField = createNumberField(texts.rateHint, rate, [0.01, MAX_RATE_HZ], (accepted) => state.change(id, { rate: accepted }));
    const head = h(
      "div",
      { class: "toolbar" },
      onBox,
      h("span", { class: "note" }, kind),
      h("span", { class: "spacer" }),
      this.note,
      rateField,
      h("span", { class: "unit" }, "Hz"),
      createButton(texts.onceHint, () => state.publishOnce(id), "tool", texts.once),
      createButton(texts.remove(topic), () => state.remove(id), "tool", createIcon("close")),
    );
    this.element = h("section", { class: "publisher", data: { publisher: topic } }, head, this.text, this.problem);
    this.showState(undefined);
  }

  showText(text: string): void {
    if (document.activeElement !== this.text) this.text.value = text;
  }

  showState(state: PublisherState | undefined): void {
    const texts = strings.monitor.publishers;
    this.note.textContent = state === undefined ? "" : texts.published(state.count, state.subscribers);
    this.problem.textContent = state?.error ?? "";
    this.problem.hidden = (state?.error ?? null) === null;
  }
}
