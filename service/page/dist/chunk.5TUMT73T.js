import{j as n}from"/page/chunk.XR7ZMISG.js";var t=n("");function i(o){t.value=o}export{t as a,i as b};
