import { findObviousDisplay } from "../../state/obvious-display";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { showNotice } from "../../widgets/dialog";

/** Adds the obvious display of a topic, unless an enabled display shows the topic already. */
export function showTopic(session: Session, topic: string): void {
  const { configuration, displays } = session;
  if (displays.displays.some(({ isEnabled, rows }) => isEnabled && rows.text("", "Topic") === topic)) return;
  const unsubscribe = configuration.choicesArrived.on(() => {
    unsubscribe();
    const choice = configuration.choices?.topics.find((candidate) => candidate.topic === topic && candidate.classes.length > 0);
    const cls = choice ? findObviousDisplay(choice) : null;
    if (cls === null) showNotice(topic, strings.displays.topicNotShown);
    else configuration.add(cls, cls.slice(cls.lastIndexOf("/") + 1), null, topic);
  });
  configuration.requestChoices();
}
