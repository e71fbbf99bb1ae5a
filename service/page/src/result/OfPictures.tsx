// What there is to say of each of several pictures; folded where it is good.
import { viewTitles } from "../measure/views";
import { messages } from "../messages";
import type { FactsProps } from "./Facts";
import { OfPicture, hasNotes } from "./OfPicture";

export function OfPictures({ result: { views }, onSayWhich, onCorrect }: FactsProps) {
  const titles = viewTitles(views);
  return (
    <>
      {views.map((view) => (
        <details class="section fold-section" key={view.number} open={hasNotes(view)} data-view={view.number}>
          <summary>
            <h2>{titles[view.number]}</h2>
          </summary>
          <div class="of-picture">
            <OfPicture view={view} views={views} asked={null} onSayWhich={onSayWhich} />
            {onCorrect && (
              <button class="button is-small" type="button" onClick={() => onCorrect(view.number)}>
                {messages.result.correct}
              </button>
            )}
          </div>
        </details>
      ))}
    </>
  );
}
