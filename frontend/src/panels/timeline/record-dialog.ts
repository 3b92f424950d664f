import { h } from "../../dom";
import type { TopicRow } from "../../protocol";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { Dialog } from "../../widgets/dialog";

/** Lets the user choose the topics to record. */
export function chooseTopics(session: Session): void {
  const texts = strings.recording;
  const { topics } = session.monitor;
  const chosenTopics = new Set<string>();
  const list = h("div", { class: "choices record-topics", role: "group", aria: { label: texts.topics } });
  const dialog = new Dialog(
    texts.chooseTitle,
    [h("p", {}, texts.chooseHint), list],
    [
      { label: strings.shell.cancel },
      {
        label: texts.begin,
        isPrimary: true,
        run: () => {
          session.recording.record([...chosenTopics]);
          return undefined;
        },
      },
    ],
    "add-dialog",
  );
  const fill = (): void => {
    // Listed rows must not move under the mouse: only new topics are added.
    const listedNames = new Set([...list.querySelectorAll("input")].map(({ value }) => value));
    list.append(...topics.topics.filter(({ name }) => !listedNames.has(name)).map((topic) => createRow(topic, chosenTopics, () => (dialog.isReady = chosenTopics.size > 0))));
  };
  topics.watchList(dialog, true);
  const unsubscribe = topics.listChanged.on(fill);
  dialog.element.addEventListener("close", () => {
    unsubscribe();
    topics.watchList(dialog, false);
  });
  fill();
  dialog.isReady = false;
  dialog.open(list.querySelector("input") ?? undefined);
}

function createRow({ name, types }: TopicRow, chosenTopics: Set<string>, onChanged: () => void): HTMLElement {
  const box = h("input", { class: "check" });
  box.type = "checkbox";
  box.value = name;
  box.addEventListener("change", () => {
    if (box.checked) chosenTopics.add(name);
    else chosenTopics.delete(name);
    onChanged();
  });
  return h("label", { class: "check-label record-topic" }, box, h("span", {}, name), h("small", {}, types.join(", ")));
}
