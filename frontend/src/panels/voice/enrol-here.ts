import { button } from "../../dom";
import type { VoiceState } from "../../state/voice/voice";
import type { WordsState } from "../../state/voice/words";
import { strings } from "../../strings";

/** Whether the robot proposes to enrol words at the user's place, and the user has not started yet. */
export function proposesEnrolling(voice: VoiceState, words: WordsState): boolean {
  return voice.serverState?.proposes_enrolling === true && words.takesHere === null;
}

/** Returns a button that starts enrolment at the user's place. */
export function enrolHereButton(words: WordsState): HTMLButtonElement {
  const { enrolHere, enrolHereHint } = strings.voice.words;
  return button(enrolHereHint, () => words.enrolRequested.emit(), "tool framed primary", enrolHere);
}
