// What to look at in a fit, or in one of its pictures.
import type { Result } from "../api/fits";
import { viewNamedFirst, withViews } from "../measure/faults";
import { plainly } from "../measure/plainly";
import { pictureTitle } from "../measure/views";
import { messages } from "../messages";
import { answered } from "../ui/answered";

type Props = Pick<Result, "warnings" | "views">;

/** Who sent several pictures has clicked nothing: it is told by what is to be seen in them. */
export function WarningNotes({ warnings, views }: Props) {
  const isOfSeveral = views.length > 1;
  return (
    <>
      {warnings.map(({ code, message }) => {
        const said = isOfSeveral ? plainly("warnings", code) : answered("warnings", code);
        const view = views[viewNamedFirst(message) ?? -1]?.view;
        return (
          <p class="note" key={code + message}>
            {said === null ? withViews(message, views) : view ? messages.frame.ofField(pictureTitle(view), said) : said}
          </p>
        );
      })}
    </>
  );
}
