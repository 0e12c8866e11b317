use crc32fast::Hasher;
use std::io::{Result, Seek, SeekFrom, Write};

/// An archive (ZIP, APPNOTE 6.3 with the sizes of "ZIP64") of members that are stored as they are. Their sizes are known before their bytes,
/// so that each has its place and the bytes of all of them may come in turns.
#[derive(Debug)]
pub(crate) struct Archive<'f, F> {
    file: &'f mut F,
    members: Vec<Member>,
    /// Where the next member begins.
    end: u64,
}

/// A member: its place, and the checksum of its bytes so far.
#[derive(Debug)]
struct Member {
    name: String,
    /// Where it begins, and where its next byte goes.
    at: u64,
    next: u64,
    size: u64,
    first: Vec<u8>,
    sum: Hasher,
}

/// What stands for a number that is in the larger field.
const LARGER: u32 = u32::MAX;
/// The version of the format that has the larger fields.
const VERSION: u16 = 45;
/// Names are UTF-8.
const UTF8: u16 = 1 << 11;
/// The first day that the format knows.
const DAY: u32 = 0x0021_0000;
/// A file that its owner may write and everybody may read, on Unix.
const UNIX: u16 = 3 << 8;
const MODE: u32 = 0o100_644 << 16;

impl<'f, F: Write + Seek> Archive<'f, F> {
    /// In an empty file.
    pub(crate) fn new(file: &'f mut F) -> Self {
        Self { file, members: Vec::new(), end: 0 }
    }

    /// Makes room for a member: the bytes `first`, and `more` bytes after them.
    pub(crate) fn reserve(&mut self, name: String, first: Vec<u8>, more: u64) {
        let at = self.end;
        let size = first.len() as u64 + more;
        let mut member = Member { name, at, next: 0, size, first, sum: Hasher::new() };
        member.sum.update(&member.first);
        let begin = at + member.local(0).len() as u64;
        member.next = begin + member.first.len() as u64;
        self.end = begin + size;
        self.members.push(member);
    }

    /// Adds bytes to a member.
    pub(crate) fn add(&mut self, number: usize, bytes: &[u8]) -> Result<()> {
        let member = &mut self.members[number];
        self.file.seek(SeekFrom::Start(member.next))?;
        self.file.write_all(bytes)?;
        member.sum.update(bytes);
        member.next += bytes.len() as u64;
        Ok(())
    }

    /// Writes what comes before the bytes of each member, and the directory at the end.
    pub(crate) fn finish(self) -> Result<()> {
        let mut directory = Vec::new();
        for member in &self.members {
            let sum = member.sum.clone().finalize();
            self.file.seek(SeekFrom::Start(member.at))?;
            self.file.write_all(&member.local(sum))?;
            self.file.write_all(&member.first)?;
            directory.extend(member.central(sum));
        }
        self.file.seek(SeekFrom::Start(self.end))?;
        let (count, size) = (self.members.len() as u64, directory.len() as u64);
        let end = Fields::new(0x0606_4b50).long(44).short(UNIX | VERSION).short(VERSION).word(0).word(0);
        let end = end.long(count).long(count).long(size).long(self.end);
        let end = end.word(0x0706_4b50).word(0).long(self.end + size).word(1);
        let few = u16::try_from(count).unwrap_or(u16::MAX);
        let end = end.word(0x0605_4b50).short(0).short(0).short(few).short(few);
        let end =
            end.word(u32::try_from(size).unwrap_or(LARGER)).word(u32::try_from(self.end).unwrap_or(LARGER)).short(0);
        directory.extend(end.0);
        self.file.write_all(&directory)
    }
}

impl Member {
    fn local(&self, sum: u32) -> Vec<u8> {
        let fields = Fields::new(0x0403_4b50).short(VERSION).stored(sum).named(&self.name, 20);
        fields.text(&self.name).short(1).short(16).long(self.size).long(self.size).0
    }

    fn central(&self, sum: u32) -> Vec<u8> {
        let fields = Fields::new(0x0201_4b50).short(UNIX | VERSION).short(VERSION).stored(sum).named(&self.name, 28);
        let fields = fields.short(0).short(0).short(0).word(MODE).word(LARGER).text(&self.name);
        fields.short(1).short(24).long(self.size).long(self.size).long(self.at).0
    }
}

/// Numbers as the bytes of a record.
struct Fields(Vec<u8>);

impl Fields {
    fn new(signature: u32) -> Self {
        Self(signature.to_le_bytes().to_vec())
    }

    fn short(mut self, number: u16) -> Self {
        self.0.extend(number.to_le_bytes());
        self
    }

    fn word(mut self, number: u32) -> Self {
        self.0.extend(number.to_le_bytes());
        self
    }

    fn long(mut self, number: u64) -> Self {
        self.0.extend(number.to_le_bytes());
        self
    }

    fn text(mut self, text: &str) -> Self {
        self.0.extend(text.as_bytes());
        self
    }

    /// Flags, no compression, the day, the checksum, and the sizes, which are in the larger fields.
    fn stored(self, sum: u32) -> Self {
        self.short(UTF8).short(0).word(DAY).word(sum).word(LARGER).word(LARGER)
    }

    /// The lengths of the name and of the larger fields.
    fn named(self, name: &str, more: u16) -> Self {
        // Columns have short names: the reader of a scene checks them.
        self.short(u16::try_from(name.len()).unwrap_or(u16::MAX)).short(more)
    }
}
