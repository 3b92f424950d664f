import type { DescriptionModel } from "../../state/description-model";
import type { Session } from "../../state/session";

/** The description that the panels are about: that of the selected link's robot, else of the first robot. */
export function currentModel(session: Session): DescriptionModel | undefined {
  const display = session.focus.current?.display ?? session.robot?.display;
  return display === undefined ? undefined : session.description.of(display);
}
