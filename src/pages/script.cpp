#include "pages/assets.h"

namespace lumirank::pages {

// Everything on the page but sorting, hiding, tooltips and the slider works without this script.
const char* const kCompareScript = R"js(
'use strict';
const all = (selector, root = document) => Array.from(root.querySelectorAll(selector));
const byId = id => document.getElementById(id);

// Tooltips: the browser's own appear late, so their text is shown at once instead.
const tip = byId('tip');
for (const title of all('svg.plot .mark > title')) {
  const mark = title.parentNode, words = title.textContent;
  title.remove();
  mark.setAttribute('tabindex', '0');
  mark.setAttribute('aria-label', words);
  const show = () => {
    tip.textContent = words;
    tip.style.display = 'block';
    const box = mark.getBoundingClientRect(), width = tip.offsetWidth;
    const x = Math.min(Math.max(8, box.left + box.width / 2 - width / 2), document.documentElement.clientWidth - width - 8);
    const above = box.top - tip.offsetHeight - 8;
    tip.style.left = x + scrollX + 'px';
    tip.style.top = (above > 0 ? above : box.bottom + 8) + scrollY + 'px';
  };
  const hide = () => { tip.style.display = 'none'; };
  mark.addEventListener('pointerenter', show);
  mark.addEventListener('pointerleave', hide);
  mark.addEventListener('focus', show);
  mark.addEventListener('blur', hide);
}

// The measure of error that the plots show, and which curves.
for (const radio of all('input[name=measure]'))
  radio.addEventListener('change', () => {
    for (const plots of all('[data-measure]')) plots.classList.toggle('off', plots.dataset.measure !== radio.value);
  });
for (const button of all('.legend button'))
  button.addEventListener('click', () => {
    const show = button.getAttribute('aria-pressed') === 'false';
    button.setAttribute('aria-pressed', String(show));
    for (const g of all('.errors [data-series="' + button.dataset.key + '"]')) g.classList.toggle('off', !show);
  });

// Tables: by number where a cell has one, else by its words; what has no value comes last.
for (const button of all('thead button'))
  button.addEventListener('click', () => {
    const th = button.parentNode, table = th.closest('table'), column = th.cellIndex;
    const down = th.getAttribute('aria-sort') === 'ascending';
    for (const other of all('th', table)) other.removeAttribute('aria-sort');
    th.setAttribute('aria-sort', down ? 'descending' : 'ascending');
    const key = row => {
      const value = row.cells[column].dataset.value;
      return value === undefined ? row.cells[column].textContent : value === '' ? NaN : Number(value);
    };
    const order = (a, b) => {
      const x = key(a), y = key(b);
      if (typeof x === 'string') return (down ? -1 : 1) * x.localeCompare(y, undefined, {numeric: true});
      if (Number.isNaN(x) || Number.isNaN(y)) return Number.isNaN(x) - Number.isNaN(y);
      return down ? y - x : x - y;
    };
    const body = table.tBodies[0];
    for (const row of Array.from(body.rows).sort(order)) body.append(row);
  });

// The two images and the slider between them.
const stage = byId('stage');
if (stage) {
  const images = JSON.parse(byId('images').textContent);
  const range = byId('split');
  const side = name => ({image: byId(name), choice: byId('choose-' + name), badge: byId('badge-' + name)});
  const left = side('left'), right = side('right');
  const split = () => {
    left.image.style.clipPath = 'inset(0 ' + (100 - range.value) + '% 0 0)';
    byId('handle').style.left = range.value + '%';
  };
  const update = () => {
    const errors = document.querySelector('input[name=view]:checked').value === 'errors';
    byId('colorbar').classList.toggle('off', !errors);
    for (const s of [left, right]) {
      const entry = images[Number(s.choice.value)];
      s.image.src = errors && entry.error ? entry.error : entry.image;
      s.image.alt = entry.name;
      s.badge.textContent = entry.name + (entry.about ? ' · ' + entry.about : '');
    }
  };
  range.addEventListener('input', split);
  for (const s of [left, right]) s.choice.addEventListener('change', update);
  for (const radio of all('input[name=view]')) radio.addEventListener('change', update);
  byId('swap').addEventListener('click', () => {
    [left.choice.value, right.choice.value] = [right.choice.value, left.choice.value];
    update();
  });
  split();
  update();
}
)js";

}  // namespace lumirank::pages
