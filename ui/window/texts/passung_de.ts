<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de_DE">
<context>
    <name>Console</name>
    <message>
        <source>Studies</source>
        <translation>Studien</translation>
    </message>
    <message>
        <source>Session</source>
        <translation>Sitzung</translation>
    </message>
    <message>
        <source>loop at rest</source>
        <translation>Schleife ruht</translation>
    </message>
    <message>
        <source>Light</source>
        <translation>Hell</translation>
    </message>
    <message>
        <source>Dark</source>
        <translation>Dunkel</translation>
    </message>
</context>
<context>
    <name>Participant</name>
    <message>
        <source>Passung – participant</source>
        <translation>Passung – Versuchsperson</translation>
    </message>
</context>
<context>
    <name>RunPage</name>
    <message>
        <source>TRIALS</source>
        <translation>DURCHGÄNGE</translation>
    </message>
    <message>
        <source>Trials</source>
        <translation>Durchgänge</translation>
    </message>
    <message>
        <source>PARTICIPANT&apos;S VIEW</source>
        <translation>SICHT DER VERSUCHSPERSON</translation>
    </message>
    <message>
        <source>LAST TEN SECONDS</source>
        <translation>DIE LETZTEN ZEHN SEKUNDEN</translation>
    </message>
    <message>
        <source>Force on the hand</source>
        <translation>Kraft auf die Hand</translation>
    </message>
    <message>
        <source>Depth of the hand in the material</source>
        <translation>Tiefe der Hand im Material</translation>
    </message>
    <message>
        <source>SESSION</source>
        <translation>SITZUNG</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>Beginnen</translation>
    </message>
    <message>
        <source>Continue</source>
        <translation>Fortsetzen</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Pause</translation>
    </message>
    <message>
        <source>Ctrl+P</source>
        <translation>Strg+P</translation>
    </message>
    <message>
        <source>Repeat</source>
        <translation>Wiederholen</translation>
    </message>
    <message>
        <source>Ctrl+R</source>
        <translation>Strg+R</translation>
    </message>
    <message>
        <source>Leave out</source>
        <translation>Auslassen</translation>
    </message>
    <message>
        <source>Ctrl+K</source>
        <translation>Strg+K</translation>
    </message>
    <message>
        <source>Note or reason</source>
        <translation>Notiz oder Grund</translation>
    </message>
    <message>
        <source>Keep note</source>
        <translation>Notieren</translation>
    </message>
    <message>
        <source>Write it first.</source>
        <translation>Erst die Notiz schreiben.</translation>
    </message>
    <message>
        <source>Does not count</source>
        <translation>Zählt nicht</translation>
    </message>
    <message>
        <source>Write the reason first.</source>
        <translation>Erst den Grund schreiben.</translation>
    </message>
    <message>
        <source>Really end the session?</source>
        <translation>Sitzung wirklich beenden?</translation>
    </message>
    <message>
        <source>End the session</source>
        <translation>Sitzung beenden</translation>
    </message>
    <message>
        <source>HAPTIC LOOP</source>
        <translation>HAPTISCHE SCHLEIFE</translation>
    </message>
    <message>
        <source>Rate</source>
        <translation>Takt</translation>
    </message>
    <message>
        <source>Missed cycles</source>
        <translation>Versäumte Takte</translation>
    </message>
    <message>
        <source>Tick, typical</source>
        <translation>Rechenzeit, üblich</translation>
    </message>
    <message>
        <source>Tick, longest</source>
        <translation>Rechenzeit, längste</translation>
    </message>
    <message>
        <source>Emergency stop</source>
        <translation>Not-Halt</translation>
    </message>
    <message>
        <source>Esc</source>
        <translation>Esc</translation>
    </message>
    <message>
        <source>Attempts: %1</source>
        <translation>Versuche: %1</translation>
    </message>
    <message>
        <source>Open the participant&apos;s window</source>
        <translation>Fenster der Versuchsperson öffnen</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
</context>
<context>
    <name>StudiesPage</name>
    <message>
        <source>STUDIES</source>
        <translation>STUDIEN</translation>
    </message>
    <message>
        <source>%1 conditions · %2 trials · %3 participants</source>
        <translation>%1 Bedingungen · %2 Durchgänge · %3 Personen</translation>
    </message>
    <message>
        <source>%1, version %2 · %3</source>
        <translation>%1, Fassung %2 · %3</translation>
    </message>
    <message>
        <source>Conditions</source>
        <translation>Bedingungen</translation>
    </message>
    <message>
        <source>Trials</source>
        <translation>Durchgänge</translation>
    </message>
    <message>
        <source>in the first of %1 sessions</source>
        <translation>in der ersten von %1 Sitzungen</translation>
    </message>
    <message>
        <source>At most</source>
        <translation>Höchstens</translation>
    </message>
    <message>
        <source>min</source>
        <translation>min</translation>
    </message>
    <message>
        <source>Participants</source>
        <translation>Versuchspersonen</translation>
    </message>
    <message>
        <source>WHAT IS VARIED</source>
        <translation>WAS VARIIERT WIRD</translation>
    </message>
    <message>
        <source>WHAT IS ASKED</source>
        <translation>WAS GEFRAGT WIRD</translation>
    </message>
    <message>
        <source>Try it with the mouse</source>
        <translation>Mit der Maus ausprobieren</translation>
    </message>
    <message>
        <source>The study has problems.</source>
        <translation>Die Studie hat Mängel.</translation>
    </message>
    <message>
        <source>A session is running.</source>
        <translation>Es läuft eine Sitzung.</translation>
    </message>
    <message>
        <source>Watch a simulated participant</source>
        <translation>Simulierter Person zusehen</translation>
    </message>
    <message>
        <source>Problems: %1</source>
        <translation>Mängel: %1</translation>
    </message>
</context>
<context>
    <name>words</name>
    <message>
        <source>Trial %1 of %2 is being prepared</source>
        <translation>Durchgang %1 von %2 wird vorbereitet</translation>
    </message>
    <message>
        <source>Trial %1 of %2 waits for the start pose</source>
        <translation>Durchgang %1 von %2 wartet auf die Startlage</translation>
    </message>
    <message>
        <source>Trial %1 of %2 is running</source>
        <translation>Durchgang %1 von %2 läuft</translation>
    </message>
    <message>
        <source>No session</source>
        <translation>Keine Sitzung</translation>
    </message>
    <message>
        <source>Opening the study</source>
        <translation>Die Studie wird geöffnet</translation>
    </message>
    <message>
        <source>Between trials</source>
        <translation>Zwischen Durchgängen</translation>
    </message>
    <message>
        <source>Ready to start</source>
        <translation>Bereit</translation>
    </message>
    <message>
        <source>Paused</source>
        <translation>Angehalten</translation>
    </message>
    <message>
        <source>Emergency stop: motors are off</source>
        <translation>Not-Halt: Motoren sind aus</translation>
    </message>
    <message>
        <source>Session complete</source>
        <translation>Sitzung vollständig</translation>
    </message>
    <message>
        <source>Session ended early</source>
        <translation>Sitzung vorzeitig beendet</translation>
    </message>
    <message>
        <source>The session failed</source>
        <translation>Die Sitzung ist gescheitert</translation>
    </message>
    <message>
        <source>pauses after this trial</source>
        <translation>hält nach diesem Durchgang an</translation>
    </message>
    <message>
        <source>next: trial %1</source>
        <translation>als Nächstes: Durchgang %1</translation>
    </message>
    <message>
        <source>%1 of %2 trials are finished and stored</source>
        <translation>%1 von %2 Durchgängen sind beendet und gespeichert</translation>
    </message>
    <message>
        <source>to come</source>
        <translation>offen</translation>
    </message>
    <message>
        <source>next</source>
        <translation>als Nächstes</translation>
    </message>
    <message>
        <source>running</source>
        <translation>läuft</translation>
    </message>
    <message>
        <source>succeeded</source>
        <translation>gelungen</translation>
    </message>
    <message>
        <source>timed out</source>
        <translation>Zeit abgelaufen</translation>
    </message>
    <message>
        <source>failed</source>
        <translation>misslungen</translation>
    </message>
    <message>
        <source>aborted</source>
        <translation>abgebrochen</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>ausgelassen</translation>
    </message>
    <message>
        <source>does not count</source>
        <translation>zählt nicht</translation>
    </message>
    <message>
        <source>No session is running.</source>
        <translation>Es läuft keine Sitzung.</translation>
    </message>
    <message>
        <source>The session has begun already.</source>
        <translation>Die Sitzung hat schon begonnen.</translation>
    </message>
    <message>
        <source>The session is not paused.</source>
        <translation>Die Sitzung ist nicht angehalten.</translation>
    </message>
    <message>
        <source>No trial has ended yet.</source>
        <translation>Noch ist kein Durchgang beendet.</translation>
    </message>
    <message>
        <source>No trial is left.</source>
        <translation>Es ist kein Durchgang mehr übrig.</translation>
    </message>
    <message>
        <source>No trial is running.</source>
        <translation>Es läuft kein Durchgang.</translation>
    </message>
    <message>
        <source>Not possible now: %1</source>
        <translation>Jetzt nicht möglich: %1</translation>
    </message>
    <message>
        <source>The session begins.</source>
        <translation>Die Sitzung beginnt.</translation>
    </message>
    <message>
        <source>The session pauses after the running trial.</source>
        <translation>Die Sitzung hält nach dem laufenden Durchgang an.</translation>
    </message>
    <message>
        <source>The session goes on.</source>
        <translation>Die Sitzung geht weiter.</translation>
    </message>
    <message>
        <source>The trial is repeated.</source>
        <translation>Der Durchgang wird wiederholt.</translation>
    </message>
    <message>
        <source>The trial is left out.</source>
        <translation>Der Durchgang wird ausgelassen.</translation>
    </message>
    <message>
        <source>The attempt does not count.</source>
        <translation>Der Versuch zählt nicht.</translation>
    </message>
    <message>
        <source>One trial back.</source>
        <translation>Einen Durchgang zurück.</translation>
    </message>
    <message>
        <source>The note is stored.</source>
        <translation>Die Notiz ist gespeichert.</translation>
    </message>
    <message>
        <source>The session is ended.</source>
        <translation>Die Sitzung ist beendet.</translation>
    </message>
    <message>
        <source>The trial has succeeded.</source>
        <translation>Der Durchgang ist gelungen.</translation>
    </message>
    <message>
        <source>The trial has failed.</source>
        <translation>Der Durchgang ist misslungen.</translation>
    </message>
    <message>
        <source>Motors are off; the session is paused.</source>
        <translation>Die Motoren sind aus, die Sitzung ist angehalten.</translation>
    </message>
    <message>
        <source>Welcome</source>
        <translation>Willkommen</translation>
    </message>
    <message>
        <source>One moment</source>
        <translation>Einen Moment</translation>
    </message>
    <message>
        <source>Move to the start</source>
        <translation>Zum Start bewegen</translation>
    </message>
    <message>
        <source>Bring the part to the ring</source>
        <translation>Führen Sie das Teil in den Ring</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Pause</translation>
    </message>
    <message>
        <source>Thank you!</source>
        <translation>Vielen Dank!</translation>
    </message>
    <message>
        <source>It begins in a moment.</source>
        <translation>Gleich geht es los.</translation>
    </message>
    <message>
        <source>Hold the part still where its pale image is.</source>
        <translation>Halten Sie das Teil ruhig dort, wo sein blasses Bild ist.</translation>
    </message>
    <message>
        <source>Drag: move · wheel or Shift + drag: depth · right button or Ctrl + drag: turn</source>
        <translation>Ziehen: bewegen · Rad oder Umschalt + Ziehen: Tiefe · rechte Taste oder Strg + Ziehen: drehen</translation>
    </message>
    <message>
        <source>You may let go. It goes on when the experimenter says so.</source>
        <translation>Sie dürfen loslassen. Es geht weiter, wenn die Versuchsleitung es sagt.</translation>
    </message>
    <message>
        <source>That was all. Please tell the experimenter.</source>
        <translation>Das war alles. Bitte sagen Sie der Versuchsleitung Bescheid.</translation>
    </message>
    <message>
        <source>practice</source>
        <translation>Übung</translation>
    </message>
    <message>
        <source>catch</source>
        <translation>Fangversuch</translation>
    </message>
    <message>
        <source>main</source>
        <translation>Haupt</translation>
    </message>
    <message>
        <source>Paused: the participant&apos;s window is closed</source>
        <translation>Angehalten: Das Fenster der Versuchsperson ist zu</translation>
    </message>
    <message>
        <source>Paused: the participant&apos;s picture is lost</source>
        <translation>Angehalten: Das Bild der Versuchsperson ist ausgefallen</translation>
    </message>
    <message>
        <source>The session has not begun.</source>
        <translation>Die Sitzung hat noch nicht begonnen.</translation>
    </message>
    <message>
        <source>The session is paused already.</source>
        <translation>Die Sitzung ist schon angehalten.</translation>
    </message>
    <message>
        <source>The session pauses after this trial already.</source>
        <translation>Die Sitzung hält nach diesem Durchgang schon an.</translation>
    </message>
    <message>
        <source>The trial is repeated already.</source>
        <translation>Der Durchgang wird schon wiederholt.</translation>
    </message>
    <message>
        <source>The trial&apos;s clock has not been started.</source>
        <translation>Die Uhr des Durchgangs läuft noch nicht.</translation>
    </message>
    <message>
        <source>It needs a text.</source>
        <translation>Dazu gehört ein Text.</translation>
    </message>
    <message>
        <source>That is not the newest attempt at a trial of this session.</source>
        <translation>Das ist nicht der letzte Versuch eines Durchgangs dieser Sitzung.</translation>
    </message>
    <message>
        <source>The attempt does not count anyway.</source>
        <translation>Der Versuch zählt ohnehin nicht.</translation>
    </message>
    <message>
        <source>It cannot be stored.</source>
        <translation>Es lässt sich nicht speichern.</translation>
    </message>
    <message>
        <source>The session is paused.</source>
        <translation>Die Sitzung ist angehalten.</translation>
    </message>
    <message>
        <source>No sound: this computer has no output for it</source>
        <translation>Kein Ton: Dieser Rechner hat keinen Ausgang dafür</translation>
    </message>
    <message>
        <source>Sound: %1, delay %2 ms</source>
        <translation>Ton: %1, Verzögerung %2 ms</translation>
    </message>
    <message>
        <source>models of the parts are built: %1 %</source>
        <translation>Modelle der Teile werden gebaut: %1 %</translation>
    </message>
</context>
</TS>
