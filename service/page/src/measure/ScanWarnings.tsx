// What to look at in a scan or in one of its pictures.
import type { ScanResult } from "../api/types";
import { messages } from "../messages/language";
import { Served } from "../ui/Served";
import { viewNamedFirst, withViews } from "./faults";
import { plainly } from "./plainly";
import { pictureTitle } from "./views";

interface Props {
  readonly warnings: ScanResult["warnings"];
  readonly views: ScanResult["views"];
}

export function ScanWarnings({ warnings, views }: Props) {
  return (
    <>
      {warnings.map(({ code, message }) => {
        const said = plainly("warnings", code);
        const view = views[viewNamedFirst(message) ?? -1]?.view;
        return (
          <p class="note" key={code + message}>
            {said === null ? <Served text={withViews(message, views)} /> : view ? messages.value.frame.ofField(pictureTitle(view), said) : said}
          </p>
        );
      })}
    </>
  );
}
