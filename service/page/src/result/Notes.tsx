// How good a result is: a grade, a sentence, what to do; all else there is to know is folded.
import type { FitResult } from "../api/types";
import { messages } from "../messages";
import { viewTitles } from "../messages/viewNames";
import { notesOf } from "./remarks";
import type { Note } from "./remarks";
import { gradeOf, headingOf } from "./quality";

/** What somebody does about a note; null until it can be done. */
export type Acting = ((note: Note) => void) | null;

interface Props {
  readonly result: FitResult;
  readonly onAct: Acting;
}

/** The note that stands beside the grade; null where nothing is in doubt. */
function firstOf(result: FitResult): Note | null {
  return gradeOf(result) === "good" ? null : (notesOf(result)[0] ?? null);
}

export function Quality({ result, onAct }: Props) {
  const { result: words } = messages;
  const grade = gradeOf(result);
  const first = firstOf(result);
  return (
    <>
      <div class="result-title">
        <h1 class="title">{headingOf(result)}</h1>
        <span class={`grade is-${grade}`} data-grade={grade}>
          {words.grades[grade]}
        </span>
      </div>
      <p class="quality">{first ? <Told note={first} views={result.views} onAct={onAct} /> : words.noDoubt}</p>
    </>
  );
}

/** All that the sentence beside the grade does not say. */
export function MoreNotes({ result, onAct, onAdjust }: Props & { readonly onAdjust: ((number: number) => void) | null }) {
  const { result: words } = messages;
  const first = firstOf(result);
  const more = notesOf(result).filter((note) => note.text !== first?.text);
  const titles = viewTitles(result.views);
  if (more.length === 0) return null;
  return (
    <details class="section fold-section more-notes">
      <summary>
        <h2>{first ? words.moreNotes(more.length) : words.notes(more.length)}</h2>
      </summary>
      <ul>
        {more.map((note) => (
          <li key={note.text} class={`note ${note.isProblem ? "is-problem" : ""}`} data-code={note.code}>
            <Told note={note} views={result.views} onAct={onAct} />
          </li>
        ))}
      </ul>
      {titles.length > 1 && onAdjust && (
        <div class="row">
          {titles.map((title, number) => (
            <button key={title} class="button is-small" type="button" onClick={() => onAdjust(number)}>
              {words.adjustOf(title)}
            </button>
          ))}
        </div>
      )}
    </details>
  );
}

function Told({ note, views, onAct }: { note: Note; views: FitResult["views"]; onAct: Acting }) {
  const { frame, result: words } = messages;
  const { deed, number, text } = note;
  return (
    <>
      {views.length > 1 && number !== null ? frame.ofField(viewTitles(views)[number]!, text) : text}
      {deed && onAct && " "}
      {deed && onAct && (
        <button class="link" type="button" onClick={() => onAct(note)}>
          {words.deeds[deed]}
        </button>
      )}
    </>
  );
}
