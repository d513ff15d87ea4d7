// keeps the room's library non-empty until its first source file arrives
