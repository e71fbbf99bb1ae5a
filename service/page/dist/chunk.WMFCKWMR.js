import{j as n}from"/page/chunk.K74SRY7O.js";var t=n("");function i(o){t.value=o}export{t as a,i as b};
